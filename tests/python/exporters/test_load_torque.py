"""What an exported model says of the rigid body and the load torque."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from synthetic import joint, record


@pytest.fixture(scope="module")
def identified(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A fit without a recorded load: friction that depends on the load of its own rigid body."""
    frame = joint(rows=1500)
    torque = frame["torque"] - frame["load_torque"] + 4.0 * frame["position"].sin()
    made = frame.drop("load_torque").with_columns(torque=torque)
    return sb.fit("coulomb+load", record(tmp_path_factory.mktemp("load"), made), starts=2)


def test_the_formula_of_the_load_gives_the_torque_of_the_fit(
    identified: sb.Fit, tmp_path: Path
) -> None:
    sb.export(identified, "json", tmp_path, name="own")
    said = json.loads((tmp_path / "own.json").read_text())
    assert said["load_torque"] == said["rigid_body_torque"]
    r, model = identified.recording, identified.model
    names = {row["name"]: row["value"] for row in said["parameters"]}
    motion = {"position": r.position, "acceleration": r.acceleration}
    load = eval(said["load_torque"], {"cos": np.cos, "sin": np.sin, **names, **motion})
    assert load == pytest.approx(identified.load)
    torque = model.torque(r.velocity, r.position, r.acceleration, load_torque=load)
    assert torque == pytest.approx(identified.prediction)


@pytest.mark.parametrize(("language", "file"), [("c", "own.h"), ("rust", "own.rs")])
def test_the_header_says_it(identified: sb.Fit, language: str, file: str, tmp_path: Path) -> None:
    sb.export(identified, language, tmp_path, name="own")
    text = (tmp_path / file).read_text()
    assert "inertia * acceleration + gravity_cos * cos(position)" in text
    assert "compute it, and give it as load_torque" in text
    assert "With 0 for inertia, gravity_cos and gravity_sin it is the friction alone." in text


def test_the_friction_alone_is_the_torque_without_the_rigid_body(identified: sb.Fit) -> None:
    r, model = identified.recording, identified.model
    bodies = dict.fromkeys(("inertia", "gravity_cos", "gravity_sin"), 0.0)
    values = [
        bodies.get(name, value) for name, value in zip(model.names, model.values, strict=True)
    ]
    alone = model.with_values(np.array(values))
    given = {"position": r.position, "acceleration": r.acceleration, "load_torque": identified.load}
    assert alone.torque(r.velocity, **given) == pytest.approx(
        model.torque(r.velocity, **given) - identified.load
    )


def test_a_recorded_load_is_an_input(plain: sb.Recording, tmp_path: Path) -> None:
    sb.export(sb.fit("coulomb+load", plain, starts=1), "c", tmp_path, name="given")
    text = (tmp_path / "given.h").read_text()
    assert "load_torque, an input, is the torque at the joint without its friction" in text
    assert "rigid body" not in text
    sb.export(sb.fit("coulomb", plain), "c", tmp_path, name="none")
    assert "load_torque" not in (tmp_path / "none.h").read_text()

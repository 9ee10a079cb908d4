"""Certificates from Python: what they are about, and counterexamples that replay."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck import _core
from stribeck.base.errors import SpecError

LUGRE_1995 = {
    "bristle_stiffness": 1e5,
    "bristle_damping": np.sqrt(1e5),
    "viscous_friction": 0.4,
    "coulomb_friction": 1.0,
    "static_friction": 1.5,
    "stribeck_velocity": 1e-3,
    "stribeck_exponent": 2.0,
}


def limited(speed: float) -> sb.Certificate:
    """The 1995 example up to a speed."""
    return sb.check(sb.model("lugre", **LUGRE_1995), {"velocity": (-speed, speed)})


def test_published_limit_of_the_1995_example() -> None:
    assert limited(0.0375).passive is True
    assert limited(0.0385).passive is False


def test_counterexample_replays_to_negative_work_and_closes() -> None:
    example = limited(0.05).counterexample
    assert example is not None
    assert example.kind == "cycle"
    work, deflection = example.replay()
    assert work == example.net_work
    assert work < 0.0
    assert deflection == pytest.approx(example.deflection, rel=1e-9)


def test_counterexample_by_the_torque_alone() -> None:
    """Small steps of the public torque give the same work."""
    certificate = limited(0.05)
    example = certificate.counterexample
    assert example is not None
    z, work = example.deflection, 0.0
    stiffness, damping = LUGRE_1995["bristle_stiffness"], LUGRE_1995["bristle_damping"]
    for step in example.steps:
        count, v = 20_000, step["velocity"]
        dt = step["duration"] / count
        torque = certificate.model.torque(np.full(count, v), dt=dt, state=z)
        work += float(np.sum(torque)) * v * dt
        strength = 1.0 + 0.5 * np.exp(-((v / 1e-3) ** 2))
        # tf = s0 z + s1 (v - s0 |v|/D z) + s2 v, solved for z.
        slope = stiffness - damping * stiffness * abs(v) / strength
        z = (torque[-1] - (damping + 0.4) * v) / slope
    assert work == pytest.approx(example.net_work, rel=0.05)


def test_what_is_no_friction_is_left_out() -> None:
    model = sb.model(
        "coulomb+offset+inertia",
        viscous_friction=0.5,
        coulomb_friction=2.0,
        offset=9.0,
        inertia=1.0,
    )
    certificate = sb.check(model, {"velocity": (-1.0, 1.0)})
    assert certificate.passive is True
    assert certificate.left_out == ("offset", "inertia")
    assert certificate.friction.spec == "coulomb"
    assert certificate.margin == pytest.approx(2.0, rel=2e-3)


def test_direction_beside_an_offset() -> None:
    """A direction has one parameter fewer beside an offset; it counts as zero."""
    model = sb.model(
        "coulomb+direction+offset",
        viscous_friction=0.5,
        coulomb_friction=2.0,
        direction_viscous=-0.1,
        offset=9.0,
    )
    assert sb.check(model, {"velocity": (-1.0, 1.0)}).passive is True


def test_a_constant_torque_of_the_law_counts() -> None:
    model = sb.model("gaz_a", a1=0.2, a2=0.1, a3=1.0, a4=20.0, a5=0.0)
    certificate = sb.check(model, {"velocity": (-1.0, 1.0)})
    assert certificate.passive is False
    example = certificate.counterexample
    assert example is not None
    assert example.kind == "operating point"
    v = example.steps[0]["velocity"]
    assert float(model.torque(v)[0]) * v < 0.0


def test_load_dependence_that_wins_over_dry_friction() -> None:
    values = dict(viscous_friction=0.5, coulomb_friction=2.0, load_exponent=1.0)
    box = {"velocity": (-1.0, 1.0), "load_torque": (-30.0, 30.0)}
    constants = {"reference_load": 10.0}
    good = sb.model("coulomb+load", constants=constants, load_coulomb=0.1, **values)
    assert sb.check(good, box).passive is True
    bad = good.with_values(
        [-0.1 if name == "load_coulomb" else good.value(name) for name in good.names]
    )
    broken = sb.check(bad, box)
    assert broken.passive is False
    assert broken.counterexample is not None
    assert abs(broken.counterexample.steps[0]["load_torque"]) > 20.0


def test_law_by_formula() -> None:
    box = {"velocity": (-2.0, 2.0), "load_torque": (-5.0, 5.0)}
    law = sb.law("c1*v + c2*tanh(v/c3)*abs(load)", c1=0.5, c2=0.1, c3=1e-3)
    assert sb.check(law, box).passive is True
    # Neither proved nor broken: what an extreme picks is not followed.
    picked = sb.law("c1*v*max(1, load)", c1=0.5)
    answer = sb.check(picked, box)
    assert answer.passive is None
    assert answer.counterexample is None
    assert answer.why is not None


def test_tadese_full_at_different_loads() -> None:
    """Load terms of the right signs are passive, a term that pushes while generating is not."""
    zero = dict.fromkeys(sb.model("tadese_full").names, 0.0)
    values = zero | {
        "bristle_stiffness": 1e4,
        "bristle_damping": 5.0,
        "damping_velocity": 0.01,
        "coulomb_friction_forward": 2.0,
        "coulomb_friction_backward": 2.2,
        "viscous_level_forward": 3.0,
        "viscous_speed_forward": 1.0,
        "viscous_level_backward": 3.0,
        "viscous_speed_backward": 1.0,
    }
    for name in values:
        if name.startswith("load_rise_rate"):
            values[name] = 3.0
    along = {
        "forward_motoring": 0.1,
        "backward_generating": -0.05,
        "backward_motoring": 0.1,
        "forward_generating": -0.05,
    }
    values |= {f"load_friction_{quadrant}": x for quadrant, x in along.items()}
    box = {"velocity": (-1.0, 1.0), "temperature": (20.0, 40.0), "load_torque": (-30.0, 30.0)}
    assert sb.check(sb.model("tadese_full", **values), box).passive is True
    values["load_friction_forward_generating"] = 0.2
    broken = sb.check(sb.model("tadese_full", **values), box)
    assert broken.passive is False
    assert broken.counterexample is not None
    assert broken.counterexample.replay()[0] < 0.0


@pytest.mark.parametrize(
    ("box", "said"),
    [
        ({}, "has no velocity"),
        ({"velocity": (0.0, 0.0)}, "no motion"),
        ({"velocity": (1.0, -1.0)}, "lower end first"),
        ({"velocity": (-1.0, float("inf"))}, "finite"),
        ({"velocty": (-1.0, 1.0)}, "did you mean 'velocity'"),
    ],
)
def test_unusable_boxes(box: dict[str, tuple[float, float]], said: str) -> None:
    with pytest.raises(SpecError, match=said):
        sb.check(sb.model("lugre", **LUGRE_1995), box)


def test_values_are_needed() -> None:
    with pytest.raises(SpecError, match="has no value for"):
        sb.check(sb.model("coulomb"), {"velocity": (-1.0, 1.0)})


def test_bristle_without_strength_is_refused_with_the_point() -> None:
    values = LUGRE_1995 | {"static_friction": -0.5}
    with pytest.raises(SpecError, match=r"bristle needs dry friction above zero.* at velocity"):
        sb.check(sb.model("lugre", **values), {"velocity": (-1.0, 1.0)})


@pytest.mark.parametrize(
    ("low", "high"),
    [(2.0, -2.0), (math.nan, 1.0), (-1.0, math.nan), (-math.inf, 1.0), (0.0, 0.0), (-1e-40, 1e-40)],
)
def test_an_empty_box_proves_nothing(low: float, high: float) -> None:
    """A friction that drives, so that only an empty box could pass for a proof."""
    driving = sb.model("coulomb", viscous_friction=-5.0, coulomb_friction=0.0)
    with pytest.raises(sb.SpecError):
        sb.check(driving, {"velocity": (low, high)})
    with pytest.raises(sb.SpecError):
        sb.check(replace(driving, box={"velocity": (low, high)}))


def test_a_reversed_box_in_a_model_file_is_refused_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    model = sb.model("coulomb", viscous_friction=-5.0, coulomb_friction=0.0)
    replace(model, box={"velocity": (-2.0, 2.0)}).save(path)
    path.write_text(path.read_text().replace("[-2.0, 2.0]", "[2.0, -2.0]"))
    with pytest.raises(sb.ModelFileError, match=r"line \d+: velocity is \[2.0, -2.0\]"):
        sb.load(path)


def test_a_check_that_is_repeated_is_not_proved_again(monkeypatch: pytest.MonkeyPatch) -> None:
    proofs = []
    proof = _core.passivity

    def counted(*question: object) -> object:
        proofs.append(question)
        return proof(*question)

    monkeypatch.setattr(_core, "passivity", counted)
    model = sb.model("coulomb", coulomb_friction=1.2345, viscous_friction=0.5)
    box = {"velocity": (-1.0, 1.0)}
    first, again = sb.check(model, box), sb.check(model.with_values(model.values), box)
    assert first.to_dict() == again.to_dict() and len(proofs) == 1
    assert sb.check(model, {"velocity": (-1.0, 2.0)}).box != first.box
    other = model.with_values(model.values * [1.0, -1.0])
    assert sb.check(other, box).passive is False
    assert len(proofs) == 3

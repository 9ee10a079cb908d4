"""MJCF with the friction of one joint, read by MuJoCo itself."""

from __future__ import annotations

from pathlib import Path

import mujoco
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.base.errors import SpecError
from stribeck.cli.main import cli

BODY = '<body><joint class="knee"/><geom type="sphere" size="0.1" mass="2" pos="0.3 0 0"/></body>'


def test_mujoco_reads_the_friction(tmp_path: Path) -> None:
    friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    (path,) = sb.export(friction, "mujoco", tmp_path, name="knee").files
    arm = f'<mujoco><include file="{path.name}"/><worldbody>{BODY}</worldbody></mujoco>'
    (tmp_path / "arm.xml").write_text(arm)
    made = mujoco.MjModel.from_xml_path(str(tmp_path / "arm.xml"))
    assert made.dof_damping == pytest.approx([0.5])
    assert made.dof_frictionloss == pytest.approx([2.0])


def test_what_mujoco_lacks_is_named(tmp_path: Path) -> None:
    model = tmp_path / "knee.toml"
    values = {"load_coulomb": 0.1, "load_exponent": 1.0, "delay": 0.01}
    sb.model("coulomb+load+delay", coulomb_friction=2.0, viscous_friction=0.5, **values).save(model)
    done = CliRunner().invoke(cli, ["export", str(model), "--to", "mujoco", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    assert "no such term, so it is left out: load, delay" in done.stderr
    assert "Left out, as MuJoCo has no such term: load" in (tmp_path / "out/knee.xml").read_text()


def test_what_is_no_friction_of_mujoco_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="has neither by name"):
        sb.export(sb.Model("gaz_b", values=[1.0, 1.0, 0.0]), "mujoco", tmp_path)
    friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    for precision in ("f32", "q15"):
        with pytest.raises(SpecError, match="MJCF has no number format"):
            sb.export(friction, "mujoco", tmp_path, precision=precision)

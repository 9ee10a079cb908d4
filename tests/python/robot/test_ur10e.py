"""A UR10e that moves all six joints: fitted to two runs, judged on a third."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from stribeck.cli.main import cli

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "ur10e_robot"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DATA.is_dir(), reason="the public data sets are not at ../shared/data"),
]

ROBOT = """kind = "robot"
name = "UR10e"
convention = "standard"

[columns]
time = "t_s"
position = "q_rad_{number}"
velocity = "qd_radps_{number}"
current = "i_A_{number}"
"""
#: a [m], d [m], alpha [deg] and drive gain [N m/A] of each joint.
ROWS = (
    (0.0, 0.1807, 90.0, 10.0),
    (-0.6127, 0.0, 0.0, 10.6956),
    (-0.57155, 0.0, 0.0, 8.4566),
    (0.0, 0.17415, 90.0, 9.0029),
    (0.0, 0.11985, -90.0, 9.48),
    (0.0, 0.11655, 0.0, 10.1232),
)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("robot") / "ur10e.toml"
    keys = ("a", "d", "alpha_deg", "drive_gain")
    joints = [
        "\n[[joint]]\n" + "\n".join(f"{k} = {x}" for k, x in zip(keys, row, strict=True))
        for row in ROWS
    ]
    path.write_text(ROBOT + "\n".join(joints))
    return str(path)


def run(command: str, robot: str, *runs: str, options: tuple[str, ...] = ()) -> dict:
    files = [str(DATA / f"{name}.parquet") for name in runs]
    words = ["robot", command, *files, "--robot", robot, "--cutoff", "6", "--json", *options]
    done = CliRunner().invoke(cli, words, catch_exceptions=False)
    return json.loads(done.stdout)


def test_effects_of_each_joint(robot: str) -> None:
    judged = ("--evaluate", str(DATA / "u12.parquet"))
    found = run("improve", robot, "u14", "u8", options=judged)
    effects = {row["joint"]: [s["effect"] for s in row["steps"]] for row in found["joints"]}
    assert "load" in effects["2"]
    assert "load" in effects["3"]
    (scored,) = found["evaluated"]
    ratio = scored["ratio"]
    assert ratio[1] <= 0.80
    assert ratio[2] <= 0.92
    assert max(ratio) <= 1.02
    # The ordinary model is as good as least squares make it: no straw man.
    expected = (0.084, 0.044, 0.045, 0.057, 0.123, 0.069)
    for ours, published in zip(scored["relative_residual_ordinary"], expected, strict=True):
        assert ours < 1.05 * published
    assert found["consistent"]


def test_payload(robot: str) -> None:
    found = run("fit", robot, "u14", "u8", "l14", options=("--payload", "l14"))
    payload = found["payload"]
    low, high = payload["ci95"]
    assert 0.0 < low < payload["mass"] < high
    assert high - low < 0.2 * payload["mass"]

"""Test-bench protocols: found in recordings with known friction, and turned into points."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import bench
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.fitting.protocols.breakaway import breakaways, dependence
from stribeck.fitting.protocols.coast_down import coast_down_points, coast_downs
from stribeck.fitting.protocols.found import found_protocols
from stribeck.fitting.protocols.loops import presliding_loops
from stribeck.fitting.protocols.points import (
    breakaway_points,
    bristle_stiffness,
    protocol_points,
)

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT.parent / "shared" / "data"
SIDECARS = ROOT / "tests" / "sidecars"


def read(folder: Path, frame: pl.DataFrame, **options: Any) -> sb.Recording:
    path = folder / "log.parquet"
    frame.write_parquet(path)
    return sb.read(path, **{"standstill": True, **options})


@pytest.mark.parametrize(
    ("bristle", "noise", "least", "most"),
    [
        # Bias of the mean, of the static friction: late by what noise hides ...
        (False, 1e-6, -0.002, 0.004),
        (False, 1e-4, -0.002, 0.012),
        # ... and with a bristle early, by the creep before it slides.
        (True, 1e-5, -0.03, 0.005),
    ],
)
def test_static_friction_of_ramps(
    tmp_path: Path, bristle: bool, noise: float, least: float, most: float
) -> None:
    exact = bench.ramps([1.0, 2.0, 5.0, 10.0], bristle=bristle)
    errors, scores = [], []
    for seed in range(5):
        found = breakaways(read(tmp_path, bench.measured(exact, position=noise, seed=seed)))
        assert len(found) == 4
        assert [np.sign(b.torque) for b in found] == [1.0, -1.0, 1.0, -1.0]
        assert [abs(b.rate) for b in found] == pytest.approx([1.0, 2.0, 5.0, 10.0], rel=0.3)
        errors += [abs(b.torque) - bench.STATIC for b in found]
        scores += [(abs(b.torque) - bench.STATIC) / b.stderr for b in found]
    assert least < np.mean(errors) / bench.STATIC < most
    assert np.mean(np.abs(scores) < 2.5) >= 0.9


def test_dwell_and_rate_are_told_apart(tmp_path: Path) -> None:
    """Static friction that rises by 0.5 N m per tenfold dwell, at rates that do not matter."""
    rng = np.random.default_rng(2)
    rests = [0.3, 1.0, 3.0, 10.0, 0.5, 2.0, 6.0, 0.8]
    rates = list(rng.permutation([4.0, 8.0, 16.0, 32.0, 5.0, 10.0, 20.0, 30.0]))
    statics = [
        5.0 + 0.5 * np.log10(rest + 5.0 / rate) for rest, rate in zip(rests, rates, strict=True)
    ]
    exact = bench.ramps(rates, rests=rests, statics=statics)
    found = breakaways(read(tmp_path, bench.measured(exact, position=1e-6)))
    assert len(found) == 8
    of = dependence(found)
    assert of["dwell"].low is not None and of["dwell"].high is not None
    assert of["dwell"].slope == pytest.approx(0.5, abs=0.12)
    assert of["dwell"].low > 0.2
    assert of["rate"].slope == pytest.approx(0.0, abs=0.15)
    few = dependence(found[:3])
    assert few["dwell"].slope is None and "at least 5" in str(few["dwell"].why)


def test_coast_downs_give_friction_from_the_inertia(tmp_path: Path) -> None:
    recording = read(tmp_path, bench.measured(bench.releases(2)), inertia=0.3)
    assert len(coast_downs(recording)) == 4
    points = coast_down_points(recording, bins=8)
    v = points.velocity
    error = points.friction_torque - (2.0 * np.sign(v) + 0.8 * v)
    stderr = np.array([p.friction_stderr for p in points.points])
    # The filter of the acceleration still sees the release in the first of eight points.
    assert np.abs(error / points.friction_torque).max() < 0.01 and abs(error.mean()) < 0.004
    assert np.mean(np.abs(error) < 2.0 * stderr) >= 0.85
    points.write(tmp_path / "points.csv")
    fit = sb.fit("coulomb", sb.read(tmp_path / "points.csv"))
    assert fit.model.value("coulomb_friction") == pytest.approx(2.0, rel=0.01)
    assert fit.model.value("viscous_friction") == pytest.approx(0.8, rel=0.01)


def test_without_inertia_a_coast_down_is_found_and_asks_for_it(tmp_path: Path) -> None:
    recording = read(tmp_path, bench.measured(bench.releases(1)))
    with pytest.raises(FitError, match="has 2 coast-downs but no load torque: give the inertia"):
        coast_down_points(recording)


@pytest.mark.parametrize("amplitude", [1.0, 2.5])
@pytest.mark.parametrize("noise", [1e-8, 1e-6])
def test_presliding_loops_show_the_bristle(tmp_path: Path, amplitude: float, noise: float) -> None:
    exact = bench.small_loops(amplitude)
    recording = read(tmp_path, bench.measured(exact, position=noise))
    loops = presliding_loops(recording)
    assert len(loops) == 4
    assert [loop.stiffness for loop in loops] == pytest.approx([bench.STIFFNESS] * 4, rel=0.02)
    # The area of the exact loop, without noise.
    tau, q = (exact[name].to_numpy()[3500:5500] for name in ("torque", "position"))
    area = float(np.sum(0.5 * (tau[1:] + tau[:-1]) * np.diff(q)))
    assert np.mean([loop.area for loop in loops]) == pytest.approx(area, rel=0.1)
    made = bristle_stiffness(recording)
    value, width = map(float, made.prior.removeprefix("bristle_stiffness=").split("+-"))
    assert abs(value - bench.STIFFNESS) < width


def test_one_kind_is_not_taken_for_another(tmp_path: Path) -> None:
    kinds = {
        "breakaway": bench.ramps([2.0, 5.0, 10.0]),
        "coast_down": bench.releases(1),
        "presliding": bench.small_loops(2.5),
    }
    for kind, frame in kinds.items():
        recording = read(tmp_path, bench.measured(frame, position=1e-6))
        found = {p.protocol for p in found_protocols(recording)} - {"plateau"}
        # A ramp ends in a release; a push from rest is a step and no ramp.
        assert found - {"coast_down"} <= {kind} and kind in found


def test_a_whole_bench_becomes_one_static_map(tmp_path: Path) -> None:
    """Ramps and coast-downs in one file: a Stribeck curve from points of both."""
    ramps = bench.ramps([2.0, 3.0, 2.0, 3.0])
    push, free = np.full(800, 6.0), np.zeros(2500)
    torque = np.concatenate([push, free, -push, free])
    model = bench.joint_friction()
    coast = bench.driven(model, torque, 0.1).with_columns(pl.col("time") + 20.0)
    both = pl.concat([ramps, coast.with_columns(pl.col("position") + ramps["position"][-1])])
    recording = read(tmp_path, bench.measured(both, position=1e-6), inertia=0.1)
    points = protocol_points(recording)
    points.write(tmp_path / "points.csv")
    law = sb.read(tmp_path / "points.csv")
    fit = sb.fit("bittencourt_a", law, fix={"stribeck_exponent": 2.0})
    assert fit.model.value("coulomb_friction") == pytest.approx(bench.COULOMB, rel=0.03)
    static = fit.model.value("coulomb_friction") + fit.model.value("stribeck_height")
    assert static == pytest.approx(bench.STATIC, rel=0.05)


@pytest.mark.slow
def test_the_command_lists_and_reduces(tmp_path: Path) -> None:
    log, points = tmp_path / "ramps.csv", tmp_path / "points.csv"
    bench.measured(bench.ramps([2.0, 5.0])).write_csv(log)
    shown = stribeck("inspect", log)
    assert "breakaway: 2 breakaways from rest at 5.0" in shown.stdout
    assert "stribeck points --method METHOD" in shown.stdout
    (row,) = [
        p
        for p in json.loads(stribeck("inspect", log, "--json").stdout)["protocols"]
        if p["protocol"] == "breakaway"
    ]
    assert row["count"] == 2
    made = json.loads(
        stribeck("points", log, "--method", "breakaway", "-o", points, "--json").stdout
    )
    assert len(made["points"]) == 2 and points.exists()
    none = stribeck("points", log, "--method", "presliding", code=2)
    assert none.stdout == ""
    last = none.stderr.splitlines()[-1]
    assert last.startswith("stribeck: ") and "has no presliding loop" in last
    loops = tmp_path / "loops.csv"
    bench.measured(bench.small_loops(2.5), position=1e-7).write_csv(loops)
    refused = stribeck("points", loops, "--method", "presliding", "-o", points, code=2)
    assert "-o has no effect with --method presliding" in refused.stderr
    assert "--prior" in stribeck("points", loops, "--method", "presliding").stdout


def stribeck(*words: object, code: int = 0) -> subprocess.CompletedProcess[str]:
    """Run the command as a user does."""
    command = [sys.executable, "-m", "stribeck", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == code, done.stderr
    return done


def test_nothing_is_found_without_a_protocol(tmp_path: Path) -> None:
    demo = sb.read(ROOT / "python" / "stribeck" / "data" / "demo.parquet")
    assert found_protocols(demo) == ()
    with pytest.raises(FitError, match="has no breakaway"):
        breakaway_points(demo)
    with pytest.raises(FitError, match="has no coast-down"):
        coast_down_points(demo)


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="published measurements are not at ../shared/data")
def test_closed_loop_measurements_hold_no_loops_and_no_coast_downs() -> None:
    """No arm or slide was released or kept in presliding; ramps from rest begin some runs."""
    files = {"emps": "emps/emps.parquet", "emps_pulses": "emps/emps_pulses.parquet"}
    files |= {f"ur10e_joint_{j}": f"ur10e/ur-20_01_22-joint_{j}.parquet" for j in range(1, 7)}
    for name, file in files.items():
        recording = sb.read(DATA / file, sidecar=SIDECARS / f"{name}.sidecar.toml")
        # The slide of EMPS moves in trapezoids.
        plateaux = ["plateau"] if name.startswith("emps") else []
        assert [p.protocol for p in found_protocols(recording)] == plateaux, name
    for file in ("u14", "l14", "u8", "u12"):
        for joint in "123456":
            path = DATA / "ur10e_robot" / f"{file}.parquet"
            recording = sb.read(path, joint=joint, torque_constant=10.0)
            assert not breakaways(recording), (file, joint)
            assert not coast_downs(recording), (file, joint)
            assert not presliding_loops(recording), (file, joint)

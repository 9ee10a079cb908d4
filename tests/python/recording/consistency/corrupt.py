"""Recordings, and what goes wrong with them: one row of `TABLE` for each kind of corruption.

A corruption is detectable if the channels that remain contradict each other. The others (a uniform
scale of the torque without a load, units of the motor side throughout, a unit of a position without
a velocity) are listed in `UNDETECTABLE` with the reason.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import stribeck as sb
from stribeck.base.errors import RecordingError, spell_options
from stribeck.motion.generate.hidden import generate

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data"
DEMO = ROOT / "python" / "stribeck" / "data" / "demo.parquet"
DEG, RPM, TURN = 180.0 / np.pi, 30.0 / np.pi, 0.5 / np.pi
GAIN = {1: 10.0, 2: 10.6956, 3: 8.4566}


@dataclass(frozen=True)
class Corruption:
    """What is done to a recording.

    Attributes
    ----------
    needs
        Channels without which it cannot be made, or cannot be seen.
    change
        From the clean table to the corrupted one.
    kinds
        Joint kinds that it makes sense for.
    checks
        Channels that must be right again after the proposed remedy.
    """

    name: str
    needs: tuple[str, ...]
    change: Callable[[pl.DataFrame], pl.DataFrame]
    kinds: tuple[str, ...] = ("revolute", "prismatic")
    checks: tuple[str, ...] = ("position", "velocity", "torque")


def scaled(**factors: float) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """Multiply columns."""
    return lambda t: t.with_columns(pl.col(c) * f for c, f in factors.items())


def shifted(column: str, seconds: float) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """Record a column later."""

    def change(t: pl.DataFrame) -> pl.DataFrame:
        time = t["time"].to_numpy()
        late = np.interp(time - seconds, time, t[column].to_numpy())
        return t.with_columns(pl.Series(column, late))

    return change


def wrapped(period: float, low: float, gain: float = 1.0) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """Wrap a position, after widening the whole motion until it passes the ends several times."""

    def change(t: pl.DataFrame) -> pl.DataFrame:
        q = t["position"].to_numpy() * gain
        return t.with_columns(pl.Series("position", (q - low) % period + low))

    return change


def constant(column: str, value: float) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """A column that never changes."""
    return lambda t: t.with_columns(pl.lit(value).alias(column))


def clock(factor: float, start: float = 0.0, whole: bool = True) -> Callable[..., pl.DataFrame]:
    """Time stamps in a fraction of a second."""

    def change(t: pl.DataFrame) -> pl.DataFrame:
        stamps = (t["time"].to_numpy() - t["time"][0]) * factor
        if whole:
            return t.with_columns(pl.Series("time", np.round(stamps).astype(np.int64) + int(start)))
        return t.with_columns(pl.Series("time", stamps + start))

    return change


def from_other(channel: str, column: str) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """Exchange a channel with that of another joint, which the table also has."""
    return lambda t: t.with_columns(pl.col(column).alias(channel), pl.col(channel).alias(column))


REVOLUTE, PRISMATIC = ("revolute",), ("prismatic",)
QV = ("position", "velocity")
TABLE = (
    Corruption("velocity in deg/s", QV, scaled(velocity=DEG), REVOLUTE),
    Corruption("velocity in rpm", QV, scaled(velocity=RPM), REVOLUTE),
    Corruption("velocity in rev/s", QV, scaled(velocity=TURN), REVOLUTE),
    Corruption("velocity in mm/s", QV, scaled(velocity=1e3), PRISMATIC),
    Corruption("velocity reversed", QV, scaled(velocity=-1.0)),
    Corruption("velocity at the motor", QV, scaled(velocity=101.0)),
    Corruption("velocity at the motor in rpm", QV, scaled(velocity=50.0 * RPM), REVOLUTE),
    Corruption("velocity 1.2 times", QV, scaled(velocity=1.2)),
    Corruption("velocity half", QV, scaled(velocity=0.5)),
    Corruption("velocity half a second late", QV, shifted("velocity", 0.5)),
    Corruption("velocity zero", QV, constant("velocity", 0.0)),
    Corruption("position in deg", QV, scaled(position=DEG), REVOLUTE),
    Corruption("position in turns", QV, scaled(position=TURN), REVOLUTE),
    Corruption("position in mm", QV, scaled(position=1e3), PRISMATIC),
    Corruption("position reversed", QV, scaled(position=-1.0)),
    Corruption("position at the motor", QV, scaled(position=101.0)),
    Corruption("position constant", QV, constant("position", 0.7), checks=("velocity", "torque")),
    Corruption("deg and rpm", QV, scaled(position=DEG, velocity=RPM), REVOLUTE),
    Corruption("deg and rev/s", QV, scaled(position=DEG, velocity=TURN), REVOLUTE),
    Corruption("position wraps at pi", QV, wrapped(0.4, -0.2), REVOLUTE, ("velocity",)),
    Corruption("time in ms", QV, clock(1e3)),
    Corruption("time in us", QV, clock(1e6)),
    Corruption("time in ns", QV, clock(1e9)),
    Corruption("time in ms since 1970", QV, clock(1e3, 1.7e12)),
    Corruption("time in ns since 1970", QV, clock(1e9, 1.7e18)),
    Corruption("time in ms, position alone", ("position", "no velocity"), clock(1e3)),
    Corruption("acceleration in deg/s2", ("acceleration",), scaled(acceleration=DEG), REVOLUTE),
    Corruption("acceleration reversed", ("acceleration",), scaled(acceleration=-1.0)),
    Corruption("acceleration zero", ("acceleration",), constant("acceleration", 0.0)),
    Corruption("acceleration late", ("acceleration",), shifted("acceleration", 0.5)),
    Corruption("torque reversed", ("torque",), scaled(torque=-1.0)),
    Corruption("torque in mN m", ("load_torque",), scaled(torque=1e3)),
    Corruption("load reversed", ("load_torque",), scaled(load_torque=-1.0)),
    Corruption("load in mN m", ("load_torque",), scaled(load_torque=1e3)),
    Corruption("temperature in K", ("temperature",), lambda t: t.with_columns(
        pl.col("temperature") + 273.15)),
    Corruption("temperature in 0.1 degC", ("temperature",), scaled(temperature=10.0)),
    Corruption("velocity of another joint", ("velocity_9",), from_other("velocity", "velocity_9")),
    Corruption("position of another joint", ("position_9",), from_other("position", "position_9")),
    Corruption("torque of another joint", ("torque_9",), from_other("torque", "torque_9")),
)  # fmt: skip

#: What leaves every relation between the channels as it is.
UNDETECTABLE = (
    Corruption("torque scaled, without a load", ("torque", "no load_torque"), scaled(torque=1e3)),
    Corruption(
        "every channel of the motion at the motor",
        (),
        scaled(position=101.0, velocity=101.0, acceleration=101.0),
    ),
    Corruption(
        "every channel of the motion in degrees",
        (),
        scaled(position=DEG, velocity=DEG, acceleration=DEG),
    ),
    Corruption(
        "position in degrees, alone",
        ("no velocity", "no acceleration", "no load_torque"),
        scaled(position=DEG),
    ),
)

Recorded = tuple[pl.DataFrame, dict[str, Any]]


def sources(names: list[str] | None = None) -> dict[str, Recorded]:
    """Clean recordings by name, with the options that read them; some of them, or all."""
    made: dict[str, Callable[[], Recorded]] = {
        "demo": lambda: (pl.read_parquet(DEMO), {"joint_kind": "revolute"}),
        "simulated revolute": lambda: _simulated("revolute"),
        "simulated prismatic": lambda: _simulated("prismatic"),
    }
    if DATA.is_dir():
        made |= {f"UR10e {j}": lambda j=j: _ur10e(j) for j in (1, 2, 3)}
        made["EMPS"] = lambda: _emps(velocity=False)
        made["EMPS with velocity"] = lambda: _emps(velocity=True)
    return {name: make() for name, make in made.items() if names is None or name in names}


def _simulated(kind: str) -> Recorded:
    frame, _ = generate(["stribeck"], seconds=40.0, rate=100.0, seed=3, joint_kind=kind)
    return frame, {"joint_kind": kind}


def _ur10e(j: int) -> tuple[pl.DataFrame, dict[str, Any]]:
    t = pl.read_parquet(DATA / "ur10e" / f"ur-20_01_22-joint_{j}.parquet")
    other = 2 if j == 1 else 1
    columns = {"time": t["t_s"]}
    for name, n in (("", j), ("_9", other)):
        columns |= {
            f"position{name}": t[f"q_rad_{n}"],
            f"velocity{name}": t[f"qd_radps_{n}"],
            f"torque{name}": t[f"i_A_{n}"] * GAIN[n],
        }
    return pl.DataFrame(columns), {"joint_kind": "revolute"}


def _emps(*, velocity: bool) -> tuple[pl.DataFrame, dict[str, Any]]:
    t = pl.read_parquet(DATA / "emps" / "emps.parquet")
    frame = t.select(
        pl.col("t_s").alias("time"),
        pl.col("q_m").alias("position"),
        pl.col("force_N").alias("torque"),
    )
    if velocity:
        slope = sb.read(DATA / "emps" / "emps.parquet").velocity
        frame = frame.with_columns(pl.Series("velocity", slope))
    return frame, {"joint_kind": "prismatic"}


def applies(corruption: Corruption, frame: pl.DataFrame, options: Mapping[str, Any]) -> bool:
    """Whether a recording has what a corruption needs."""
    wanted = [name for name in corruption.needs if not name.startswith("no ")]
    absent = [name[3:] for name in corruption.needs if name.startswith("no ")]
    return (
        options["joint_kind"] in corruption.kinds
        and all(name in frame.columns for name in wanted)
        and not any(name in frame.columns for name in absent)
    )


@dataclass(frozen=True)
class Outcome:
    """What became of a corrupted recording.

    Attributes
    ----------
    verdict
        ``refused``, ``mended`` or ``unseen``.
    right
        Whether the mended recording, or one read as proposed, is the clean one again.
    said
        The refusal, or the notes.
    """

    verdict: str
    right: bool
    said: str


def judged(
    corruption: Corruption, frame: pl.DataFrame, options: Mapping[str, Any], folder: Path
) -> Outcome:
    """Corrupt a recording, read it, and read it again as proposed."""
    clean = _read(frame, folder / "clean.parquet", options)
    changed = corruption.change(frame)
    assert not [c for c in clean.checks if not c.ok], clean.checks
    path = folder / "corrupted.parquet"
    try:
        recording = _read(changed, path, options)
        recording.require_consistent()
    except RecordingError as error:
        proposals = _proposals(str(error))
        right = any(_same(corruption, clean, path, options, given) for given in proposals)
        return Outcome("refused", right, str(error))
    same = _same(corruption, clean, path, options, {})
    notes = "; ".join(recording.notes)
    return Outcome("mended" if same else "unseen", same, notes)


def _read(frame: pl.DataFrame, path: Path, options: Mapping[str, Any]) -> sb.Recording:
    frame.write_parquet(path)
    return sb.read(path, **options)


def _proposals(sentence: str) -> list[dict[str, list[str]]]:
    """The options that a sentence proposes, alternative by alternative."""
    found = []
    for part in re.split(r"; otherwise |, or |; or ", sentence):
        given: dict[str, list[str]] = {}

        def take(name: str, value: str | None, given: dict[str, list[str]] = given) -> str:
            if value is not None:
                given.setdefault(name, []).append(value)
            return ""

        spell_options(part, take)
        if given:
            found.append(given)
    return found


def _same(
    corruption: Corruption,
    clean: sb.Recording,
    path: Path,
    options: Mapping[str, Any],
    given: Mapping[str, list[str]],
) -> bool:
    """Whether the recording read as proposed has the clean channels."""
    try:
        recording = sb.read(path, **{**options, **given})
        recording.require_consistent()
    except (RecordingError, TypeError):
        return False
    rows = slice(5, min(len(clean), len(recording)) - 5)
    if abs(len(clean) - len(recording)) > 0.05 * len(clean):
        return False
    for channel in corruption.checks:
        was, now = getattr(clean, channel), getattr(recording, channel)
        if was is None or now is None:
            continue
        # A position without its turns, and what is derived, are the same to within their noise.
        off = (
            np.diff(now[rows]) - np.diff(was[rows]) if channel == "position" else (now - was)[rows]
        )
        if np.sqrt(np.mean(off**2)) > 0.05 * np.sqrt(np.mean((was - was.mean()) ** 2)):
            return False
    return bool(abs(recording.rate_hz / clean.rate_hz - 1.0) < 0.01)

"""What a recording can show: each effect's needs, checked on the data.

One function an effect, returning nothing when its need is met, or why not and what to do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.periodogram import FEWEST_PERIODS, most_periods
from stribeck.models.catalog import effect_ids
from stribeck.recording.recording import Recording
from stribeck.recording.rows import noise_level

Array = NDArray[np.float64]

#: Both directions count as present from this share of the moving rows on.
BOTH_DIRECTIONS = 0.05
#: Temperature span (1st to 99th percentile) in K below which no thermal effect is looked for.
TEMPERATURE_SPAN = 5.0
#: Slow motion: slower than this share of the largest speed.
SLOW = 0.15
#: Ratio of fast to slow speeds from which the curve of viscous friction shows.
SPEED_RATIO = 2.5
#: Relative spread of the load (or of the inertia torque) that shows a dependence on it.
LOAD_SPREAD = 0.1
#: Share of rows that motoring and generating each need.
QUADRANT_SHARE = 0.1
#: Turns of direction needed to see what happens in them.
REVERSALS = 4
#: Range of a revolute joint in rad below which gravity cannot be told from an offset.
GRAVITY_RANGE = 0.3
#: Temperature span in K below which temperature cannot pass for a drift.
DRIFT_TEMPERATURE = 1.0
#: Rank correlation of temperature and time from which one passes for the other.
DRIFT_FOLLOWS = 0.9
#: Time (s) in which slow speeds must be passed for a lag of some hundredths of a second to show.
SLOW_PASS = 2.0
#: A drive train softer than this resonates visibly in any joint, Hz.
SOFT_DRIVE = 5.0
#: Least torque that such a drive train must show, as shares of the load torque and of the noise:
#: some ten thousand rows see a fiftieth of their noise.
TWIST_SHARE, TWIST_NOISE = 1e-3, 0.02
#: Ratio of the largest torque to the usual one from which a curve over torque shows.
TORQUE_RATIO = 2.0


@dataclass(frozen=True)
class Untestable:
    """An effect that the data cannot show: why, and the motion or sensor that would."""

    effect: str
    why: str
    do: str

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON."""
        return {"effect": self.effect, "why": self.why, "do": self.do}


@dataclass(frozen=True)
class _Facts:
    """What the checks look at, on the scored rows."""

    recording: Recording
    load: Array | None
    velocity: Array
    forward: float
    speed: Array
    reversals: int

    @classmethod
    def of(cls, recording: Recording, load: Array | None) -> _Facts:
        v = recording.velocity[recording.moving]
        turned = np.diff(np.sign(v)) != 0
        within = np.diff(recording.segment[recording.moving]) == 0
        return cls(
            recording=recording,
            load=recording.load_torque if recording.load_torque is not None else load,
            velocity=v,
            forward=float(np.mean(v > 0)) if v.size else 0.0,
            speed=np.abs(v),
            reversals=int(np.count_nonzero(turned & within)),
        )

    @property
    def both_directions(self) -> bool:
        return BOTH_DIRECTIONS <= self.forward <= 1.0 - BOTH_DIRECTIONS

    def channel(self, name: str) -> Array | None:
        column = getattr(self.recording, name)
        return None if column is None else column[self.recording.moving]


def _spread(values: Array) -> float:
    low, high = np.quantile(values, [0.01, 0.99])
    return float(high - low)


Answer = tuple[str, str] | None


def _one_direction(f: _Facts) -> Answer:
    if f.both_directions:
        return None
    way = "forward" if f.forward > 0.5 else "backward"
    return (f"the joint moves {way} only", "move in both directions over the same stroke")


def _stribeck(f: _Facts) -> Answer:
    if (only := _one_direction(f)) is not None:
        return only
    top = float(np.quantile(f.speed, 0.99))
    slow = f.speed < SLOW * top
    both = np.count_nonzero(slow & (f.velocity > 0)), np.count_nonzero(slow & (f.velocity < 0))
    if min(both) < max(5 if f.recording.averaged else 20, 0.002 * f.speed.size) and not (
        f.recording.averaged and min(both) >= 2
    ):
        unit = f.recording.position_unit
        return (
            f"hardly any motion is slower than {SLOW * top:.3g} {unit}/s "
            f"({SLOW:.0%} of the top speed)",
            "add slow passes in both directions, down to a few per cent of the top speed",
        )
    return None


def _frictional_lag(f: _Facts) -> Answer:
    if f.recording.averaged:
        return (
            "steady-state points hold no change of speed",
            "record slow passes that speed up and slow down",
        )
    if (why := _stribeck(f)) is not None:
        return why
    top = float(np.quantile(f.speed, 0.99))
    slow = f.speed < SLOW * top
    faster = (np.sign(f.velocity) * f.recording.acceleration_smooth[f.recording.moving])[slow]
    both = float(np.quantile(faster, 0.9)), float(-np.quantile(faster, 0.1))
    if SLOW * top > SLOW_PASS * min(both):
        return (
            f"the joint passes its slow speeds in more than {SLOW_PASS:.0f} s, too slowly to show "
            "a lag of friction",
            "add slow passes that speed up and slow down quickly",
        )
    return None


def _nonlinear_viscous(f: _Facts) -> Answer:
    low, high = np.quantile(f.speed, [0.05, 0.98])
    if high < SPEED_RATIO * max(low, 1e-300):
        unit = f.recording.position_unit
        return (
            f"the speeds lie between {low:.3g} and {high:.3g} {unit}/s, too narrow to show a curve",
            "move at speeds from a tenth of the top speed to the top speed",
        )
    return None


def _load(f: _Facts) -> Answer:
    if f.load is None:
        return (
            "the load torque is not known",
            "record load_torque, or a motion that shows inertia and gravity",
        )
    tl = f.load[f.recording.moving]
    size = np.abs(tl)
    scale = float(np.sqrt(np.mean(f.channel("torque") ** 2))) or 1.0  # type: ignore[operator]
    if _spread(size) < LOAD_SPREAD * scale or _spread(size) < LOAD_SPREAD * float(
        np.quantile(size, 0.99)
    ):
        return (
            "the load torque hardly varies",
            "repeat the motion in other poses or with other payloads",
        )
    power = np.sign(f.velocity) * tl
    share = float(np.mean(power > 0))
    if not 0.02 <= share <= 0.98:
        return (
            "velocity and load torque keep the same relative sign, where load-dependent friction "
            "equals an error of gravity or inertia",
            "move up and down under the same load",
        )
    return None


def _quadrant(f: _Facts) -> Answer:
    if (why := _load(f)) is not None:
        return why
    if f.recording.load_torque is None:
        return (
            "the load torque is identified together with the friction, and a common scale of "
            "inertia and gravity equals a difference between the quadrants",
            "give the load torque, or inertia and gravity from a weighing or a CAD model",
        )
    assert f.load is not None
    motoring = float(np.mean(f.velocity * f.load[f.recording.moving] > 0))
    if not QUADRANT_SHARE <= motoring <= 1.0 - QUADRANT_SHARE:
        return (
            f"the joint drives its load in {motoring:.0%} of the rows",
            "lift and lower the same load at the same speeds",
        )
    return None


def _temperature(f: _Facts) -> Answer:
    temperature = f.channel("temperature")
    if temperature is None:
        return ("no temperature was recorded", "record the joint's temperature")
    span = _spread(temperature)
    if span < TEMPERATURE_SPAN:
        return (
            f"the temperature varies by {span:.1f} K only",
            f"record from cold to warm, at least {TEMPERATURE_SPAN:.0f} K, and cool down again",
        )
    return None


def _presliding(f: _Facts) -> Answer:
    if f.recording.averaged:
        return ("steady-state points hold no reversals", "record the motion through reversals")
    if f.reversals < REVERSALS:
        return (
            f"there are {f.reversals} reversals",
            "record small back-and-forth motions through zero speed",
        )
    return None


def _position(f: _Facts) -> Answer:
    q = f.channel("position")
    if q is None:
        return ("no position was recorded", "record the joint's position")
    if (only := _one_direction(f)) is not None:
        return only
    stroke = float(np.ptp(q))
    if stroke <= 0:
        return ("the position does not vary", "move along the stroke")
    path = float(np.sum(np.abs(f.recording.velocity) * f.recording.dt))
    if path < 2.5 * stroke:
        return (
            f"the stroke is passed {path / stroke:.1f} times only",
            "pass the same stroke several times in both directions",
        )
    return None


def _inertia(f: _Facts) -> Answer:
    a = f.channel("acceleration")
    if a is None or f.recording.averaged:
        return ("steady motion holds no acceleration", "record accelerated motion")
    top = float(np.quantile(f.speed, 0.99))
    # Accelerations that would take over a minute to reach top speed show nothing.
    if float(np.sqrt(np.mean(a**2))) < top / 60.0:
        return ("the joint hardly accelerates", "record accelerated motion")
    return None


def _gravity(f: _Facts) -> Answer:
    if f.recording.joint_kind == "prismatic":
        return (
            "on a prismatic joint gravity is constant and equals an offset",
            "tilt the axis, or compare with the axis level",
        )
    q = f.channel("position")
    if q is None:
        return ("no position was recorded", "record the joint's position")
    if float(np.ptp(q)) < GRAVITY_RANGE:
        return (
            f"the joint moves through {np.ptp(q):.2g} rad only, where gravity equals an offset",
            "move through at least a quarter of a turn",
        )
    return None


def _spring(f: _Facts) -> Answer:
    if (why := _position(f)) is not None:
        return why
    q = f.channel("position")
    assert q is not None
    if f.recording.joint_kind == "revolute" and float(np.ptp(q)) < GRAVITY_RANGE:
        return (
            f"the joint moves through {np.ptp(q):.2g} rad only, where a spring equals the slope of "
            "gravity",
            "move through at least a quarter of a turn",
        )
    return None


def _ripple(f: _Facts) -> Answer:
    if (why := _position(f)) is not None:
        return why
    most = most_periods(f.recording)
    if most <= FEWEST_PERIODS:
        return (
            "the samples are too far apart to show a torque that repeats along the stroke",
            "record slow passes in both directions, at a higher rate",
        )
    return None


def _drift(f: _Facts) -> Answer:
    if f.recording.averaged:
        return (
            "steady-state points do not say when they were measured",
            "record the same motion again and again",
        )
    temperature = f.channel("temperature")
    if temperature is None:
        return (
            "no temperature was recorded, which may change friction as slowly as time",
            "record the joint's temperature",
        )
    if _spread(temperature) < DRIFT_TEMPERATURE:
        return None
    follows = float(
        scipy.stats.spearmanr(f.recording.elapsed[f.recording.moving], temperature).statistic
    )
    if abs(follows) > DRIFT_FOLLOWS:
        way = "warms up" if follows > 0 else "cools down"
        return (
            f"the joint only {way}, so that time cannot be told from temperature",
            "let the joint cool down and warm up again",
        )
    return None


def _gain(f: _Facts) -> Answer:
    if (why := _load(f)) is not None:
        return why
    if f.recording.load_torque is None:
        return (
            "the load torque is identified together with the friction, and takes up any error of "
            "the torque constant",
            "give the load torque, or inertia and gravity from a weighing or a CAD model",
        )
    if not f.recording.torque_holds_load:
        return (
            "the motor torque itself, load included, was not recorded",
            "record the motor torque, or the current with its torque constant",
        )
    return None


def _saturation(f: _Facts) -> Answer:
    if (why := _gain(f)) is not None:
        return why
    size = np.abs(f.recording.torque[f.recording.moving])
    usual, top = np.quantile(size, [0.5, 0.99])
    if top < TORQUE_RATIO * usual:
        unit = f.recording.torque_unit
        return (
            f"the largest torque of {top:.3g} {unit} is hardly above the usual {usual:.3g} {unit}",
            "add fast accelerations or heavy payloads, up to the largest torque of the motor",
        )
    return None


def _backlash(f: _Facts) -> Answer:
    if f.recording.averaged:
        return ("steady-state points hold no reversals", "record the motion through reversals")
    if f.load is None:
        return (
            "the load torque is not known",
            "record load_torque, or a motion that shows inertia and gravity",
        )
    moving = f.recording.moving
    turned = np.diff(np.sign(f.load[moving])) != 0
    reversals = int(np.count_nonzero(turned & (np.diff(f.recording.segment[moving]) == 0)))
    if reversals < REVERSALS:
        return (
            f"the load torque changes its sign {reversals} times in motion, so that the teeth "
            "hardly leave their flank",
            "move through the angle at which the load is balanced, back and forth",
        )
    return None


def _elasticity(f: _Facts) -> Answer:
    if f.recording.averaged:
        return ("steady motion holds no change of the load torque", "record accelerated motion")
    bend = f.channel("load_torque_curvature")
    load = f.channel("load_torque")
    if bend is None or load is None:
        return (
            "the load torque is not known beforehand, nor the positions on both sides of the drive "
            "train",
            "give the load torque, or inertia and gravity from a weighing or a CAD model",
        )
    # Quantiles: a payload that is swapped is no motion.
    size = float(np.quantile(np.abs(load - np.median(load)), 0.9))
    twist = float(np.quantile(np.abs(bend), 0.9)) / (2.0 * np.pi * SOFT_DRIVE) ** 2
    r = f.recording
    noise = noise_level(r.time, r.torque, r.segment)
    if twist <= max(TWIST_SHARE * size, TWIST_NOISE * noise):
        return (
            f"the load torque changes so slowly that even a drive train that resonates at "
            f"{SOFT_DRIVE:.0f} Hz would look rigid",
            "add moves that start and stop hard, or record positions at motor and joint",
        )
    return None


def _delay(f: _Facts) -> Answer:
    if f.recording.averaged:
        return ("steady-state points hold no timing", "record accelerated motion")
    return _inertia(f)


CHECKS: dict[str, Callable[[_Facts], Answer]] = {
    "stribeck": _stribeck,
    "frictional_lag": _frictional_lag,
    "nonlinear_viscous": _nonlinear_viscous,
    "direction": _one_direction,
    "load": _load,
    "quadrant": _quadrant,
    "temperature_viscous": _temperature,
    "temperature_dry": _temperature,
    "presliding": _presliding,
    "position": _position,
    "drift": _drift,
    "offset": _one_direction,
    "inertia": _inertia,
    "gravity": _gravity,
    "spring": _spring,
    "ripple": _ripple,
    "backlash": _backlash,
    "elasticity": _elasticity,
    "saturation": _saturation,
    "gain": _gain,
    "delay": _delay,
}


def untestable(recording: Recording, load: Array | None = None) -> dict[str, Untestable]:
    """Effects that `recording` cannot show, by id, with the reason and what to do instead."""
    facts = _Facts.of(recording, load)
    found = {}
    for effect in effect_ids():
        answer = CHECKS[effect](facts)
        if answer is not None:
            found[effect] = Untestable(effect, *answer)
    return found

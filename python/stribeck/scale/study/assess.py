"""Errors of the best start of a law on a joint, for tables and figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.energy import Energy, electrical_energy, joules
from stribeck.fitting.evaluate import evaluate
from stribeck.identify.left_out.rows import scored_rows
from stribeck.identify.scaling import model_for
from stribeck.recording.recording import Recording
from stribeck.scale.study.desk import Desk
from stribeck.scale.study.plan import LOW_SPEED, LawGroup, group_of
from stribeck.scale.study.trial import Trial

Array = NDArray[np.float64]

#: Samples of each joint kept for the figure of friction against velocity.
DRAWN = 1200


@dataclass(frozen=True)
class Spread:
    """Distribution of the torque error e = measured - modelled over some samples.

    Quartiles and whiskers are defined as in the box plots of the review: whiskers reach the last
    sample within 1.5 times the interquartile range of the box. NaN if there are no samples.
    """

    rows: int
    mean: float
    std: float
    quartiles: tuple[float, float, float]
    whiskers: tuple[float, float]

    @classmethod
    def of(cls, error: Array) -> Spread:
        """Compute the distribution of errors."""
        if error.size == 0:
            nan = float("nan")
            return cls(0, nan, nan, (nan, nan, nan), (nan, nan))
        low, middle, high = (float(q) for q in np.quantile(error, [0.25, 0.5, 0.75]))
        reach = 1.5 * (high - low)
        inside = error[(error >= low - reach) & (error <= high + reach)]
        return cls(
            error.size,
            float(error.mean()),
            float(error.std()),
            (low, middle, high),
            (float(inside.min()), float(inside.max())),
        )

    @property
    def rms(self) -> float:
        """Root mean square."""
        return float(np.hypot(self.mean, self.std))

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "rows": self.rows,
            "mean": self.mean,
            "std": self.std,
            "rmse": self.rms,
            "quartiles": list(self.quartiles),
            "whiskers": list(self.whiskers),
        }


@dataclass(frozen=True)
class Cloud:
    """Friction against velocity at some samples of a joint, measured and modelled."""

    velocity: Array
    measured: Array
    modelled: Array


@dataclass(frozen=True)
class Entry:
    """A law on a joint.

    Attributes
    ----------
    best
        The start with the smallest error.
    whole, low_speed
        Torque error over all scored samples, and over those at low speed.
    agreeing
        Number of starts that ended within a thousandth of the best error.
    energy, energy_all_rows
        Over the scored samples, and over all with those at rest, as the review sums. None if the
        motor is unknown.
    """

    best: Trial
    trials: int
    agreeing: int
    whole: Spread
    low_speed: Spread
    energy: Energy | None
    energy_all_rows: Energy | None
    cloud: Cloud

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            **self.whole.to_dict(),
            "rmse_held_out": self.best.rmse_held_out,
            "low_speed": self.low_speed.to_dict(),
            "energy": joules(self.energy),
            "energy_all_rows": joules(self.energy_all_rows),
            "best_start": self.best.job.start,
            "starts": self.trials,
            "starts_agreeing": self.agreeing,
            "converged": self.best.converged,
            "evaluations": self.best.evaluations,
            "parameters": dict(self.best.parameters),
        }


@dataclass(frozen=True)
class JointData:
    """Scored data of a joint.

    Attributes
    ----------
    low_speed
        Largest low speed, in the unit of velocity.
    """

    rows: int
    scored: Mapping[str, float]
    torque_unit: str
    velocity_unit: str
    low_speed: float


@dataclass(frozen=True)
class JointTrials:
    """The fits of a joint by law, and the largest low speed (None: by the kind of joint)."""

    joint: str | None
    trials: Mapping[str, Sequence[Trial]]
    low_speed: float | None


@dataclass(frozen=True)
class Assessed:
    """Results of a joint: the table of each law, and the fitted laws."""

    joint: str | None
    data: JointData
    groups: Mapping[str, LawGroup]
    entries: Mapping[str, Entry]


def assess_joint(desk: Desk, of: JointTrials) -> Assessed:
    """Assess every law on a joint."""
    recording = desk.recording(of.joint)
    low_speed = LOW_SPEED[recording.joint_kind] if of.low_speed is None else of.low_speed
    data = JointData(
        recording.rows,
        recording.scored(scored_rows(recording)),
        recording.torque_unit,
        f"{recording.position_unit}/s",
        low_speed,
    )
    groups = {law: group_of(model_for(law, recording)) for law in of.trials}
    found = {law: assess(trials, recording, low_speed) for law, trials in of.trials.items()}
    entries = {law: entry for law, entry in found.items() if entry is not None}
    return Assessed(of.joint, data, groups, entries)


def best_trial(trials: Sequence[Trial]) -> Trial | None:
    """Return the trial with the smallest error, or the first of equal ones; None if all failed."""
    fitted = [t for t in trials if t.rmse is not None and np.isfinite(t.rmse)]
    return min(fitted, key=lambda t: (t.rmse, t.job.start), default=None)


def assess(trials: Sequence[Trial], recording: Recording, low_speed: float) -> Entry | None:
    """Assess a law on a joint by its best start; None if every start failed.

    Parameters
    ----------
    low_speed
        rad/s or m/s.
    """
    best = best_trial(trials)
    if best is None or best.rmse is None:
        return None
    result = evaluate(best.model(recording), recording)
    scored = result.scored
    slow = scored & (np.abs(recording.velocity) < low_speed)
    known = recording.known_torque if result.load is None else result.load
    rows = _drawn(recording)
    limit = best.rmse * 1.001
    return Entry(
        best=best,
        trials=len(trials),
        agreeing=sum(t.rmse is not None and t.rmse <= limit for t in trials),
        whole=Spread.of(result.residual[scored]),
        low_speed=Spread.of(result.residual[slow]),
        energy=electrical_energy(recording, result.prediction, scored),
        energy_all_rows=electrical_energy(recording, result.prediction, np.ones_like(scored)),
        cloud=Cloud(
            recording.velocity[rows],
            (recording.torque - known)[rows],
            (result.prediction - known)[rows],
        ),
    )


def _drawn(recording: Recording) -> NDArray[np.intp]:
    """Return scored samples to draw: half evenly spaced in time, half evenly spaced in speed."""
    rows = np.flatnonzero(recording.moving)
    if rows.size <= DRAWN:
        return rows
    rng = np.random.default_rng(0)
    by_speed = rows[np.argsort(recording.velocity[rows], kind="stable")]
    speed = recording.velocity[by_speed]
    wanted = rng.uniform(speed[0], speed[-1], DRAWN // 2)
    evenly = by_speed[np.minimum(np.searchsorted(speed, wanted), rows.size - 1)]
    return np.unique(np.concatenate([evenly, rng.choice(rows, DRAWN // 2, replace=False)]))

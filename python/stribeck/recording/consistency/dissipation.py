"""What the torque has in common with the motion: friction, inertia and load by regression."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from stribeck.base.linear import solve
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.recording import Recording

__all__ = ["Dissipation", "Estimate", "dissipation"]

#: The regression uses at most this many moving samples.
_MOST = 20_000
#: Errors are those of leaving out each of this many blocks of time.
_BLOCKS = 10
#: Each direction has at least this share of the moving samples.
_EACH_WAY = 0.05
#: A regressor is determined if this share of its variance is not that of the others.
_OWN = 1e-3
#: Quantile of Student's t with 9 degrees of freedom: 95 % intervals from ten blocks.
T95 = 2.26


@dataclass(frozen=True)
class Estimate:
    """A coefficient and its standard error."""

    value: float
    error: float

    @property
    def interval(self) -> tuple[float, float]:
        """Its 95 % interval."""
        return self.value - T95 * self.error, self.value + T95 * self.error

    @property
    def sign(self) -> int:
        """1 or -1 where the interval excludes zero, otherwise 0."""
        low, high = self.interval
        return (low > 0.0) - (high < 0.0)


@dataclass(frozen=True)
class Dissipation:
    """The parts of the torque that follow the motion.

    Attributes
    ----------
    friction
        At the RMS speed: torque at +v minus torque at -v at like load and acceleration, over two.
        None where the motion does not determine it.
    inertia, load
        Coefficients of the acceleration and of the recorded load torque; None: not determined. What
        the regression leaves may be friction of another shape that goes with the load, in every
        part of a motion that repeats itself: the error of the load's coefficient holds that bias.
    explained
        Share of the torque's variance that all parts explain.
    """

    friction: Estimate | None
    inertia: Estimate | None
    load: Estimate | None
    explained: float


def dissipation(
    recording: Recording, velocity: Floats | None = None, torque: Floats | None = None
) -> Dissipation | None:
    """Regress the torque on the direction and size of the velocity, and on the load.

    Without a recorded load, inertia, gravity (the cosine and sine of the position, where there is
    one) and a constant take its place. The errors are those of leaving out tenths of the time
    (jackknife), so noise that is correlated in time is accounted for.

    Parameters
    ----------
    velocity, torque
        Other channels to use instead of those of the recording, [n].

    Returns
    -------
    Dissipation or None
        None where too few samples move.
    """
    rows = np.flatnonzero(recording.moving)
    if rows.size < 20 * _BLOCKS:
        return None
    rows = rows[:: max(1, rows.size // _MOST)]
    v = (recording.velocity_smooth if velocity is None else velocity)[rows]
    target = (recording.torque if torque is None else torque)[rows]
    columns = _columns(recording, rows, v)
    names = list(columns)
    table = np.stack([columns[name] for name in names], axis=1)
    size = np.sqrt(np.mean(table**2, axis=0))
    kept = [i for i, s in enumerate(size) if s > 0.0]
    names, table, size = [names[i] for i in kept], table[:, kept] / size[kept], size[kept]
    found, errors, leave_out, residual = _jackknife(table, target)
    spread = float(np.var(target))
    own = _own_share(table)

    def estimate(name: str) -> Estimate | None:
        if name not in names or own[names.index(name)] < _OWN:
            return None
        i = names.index(name)
        return Estimate(float(found[i] / size[i]), float(errors[i] / size[i]))

    direction, rate = names.index("direction"), names.index("velocity")
    both_ways = min(np.mean(v > 0.0), np.mean(v < 0.0)) >= _EACH_WAY
    friction = None
    if both_ways and own[direction] >= _OWN:
        # Both regressors are scaled to an RMS of one: their sum is the friction at the RMS speed.
        each = leave_out[:, direction] + leave_out[:, rate]
        value = float(found[direction] + found[rate])
        friction = Estimate(value, _spread(each))
    explained = 1.0 - float(np.var(residual)) / spread if spread > 0.0 else 0.0
    load = estimate("load")
    if load is not None:
        i = names.index("load")
        bias = float(np.sqrt(np.mean(residual**2) / own[i]) / size[i]) / T95
        load = Estimate(load.value, float(np.hypot(load.error, bias)))
    return Dissipation(friction, estimate("acceleration"), load, explained)


def _columns(recording: Recording, rows: Ints, v: Floats) -> dict[str, Floats]:
    """The regressors by name, [rows]."""
    columns = {
        "direction": np.sign(v),
        "velocity": v,
        "constant": np.ones(len(rows)),
    }
    load, position = recording.load_torque, recording.position
    if load is not None and recording.torque_holds_load:
        # It holds the inertia.
        columns["load"] = load[rows]
        return columns
    columns["acceleration"] = recording.acceleration_smooth[rows]
    if load is None and position is not None and recording.joint_kind == "revolute":
        columns["cosine"], columns["sine"] = np.cos(position[rows]), np.sin(position[rows])
    return columns


def _jackknife(table: Floats, target: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Coefficients, their errors, those without each block, and the residual."""
    count = table.shape[1]
    edges = np.arange(_BLOCKS + 1) * len(target) // _BLOCKS
    parts = [slice(a, b) for a, b in itertools.pairwise(edges)]
    gram = np.stack([_products(table[p], table[p]) for p in parts])
    right = np.stack([_products(table[p], target[p, None])[:, 0] for p in parts])
    ridge = 1e-9 * len(target) * np.eye(count)
    whole, side = gram.sum(axis=0) + ridge, right.sum(axis=0)
    found = solve(whole, side)
    without = np.stack([solve(whole - g, side - r) for g, r in zip(gram, right, strict=True)])
    errors = np.array([_spread(without[:, i]) for i in range(count)])
    residual = target - (table * found).sum(axis=1)
    return found, errors, without, residual


def _products(a: Floats, b: Floats) -> Floats:
    """``a.T @ b`` summed in a fixed order, whatever the number of threads."""
    return np.array([[(x * y).sum() for y in b.T] for x in a.T])


def _spread(without: Floats) -> float:
    """The jackknife's standard error."""
    n = len(without)
    return float(np.sqrt((n - 1) / n * np.sum((without - without.mean()) ** 2)))


def _own_share(table: Floats) -> Floats:
    """Share of each regressor that the others do not explain (1 / its variance inflation)."""
    gram = _products(table, table) / len(table)
    inverse = solve(gram + 1e-12 * np.eye(len(gram)), np.eye(len(gram)))
    return 1.0 / (np.diag(inverse) * np.diag(gram))

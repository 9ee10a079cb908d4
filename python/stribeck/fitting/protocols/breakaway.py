"""Breakaway: the torque of a joint at rest rises until it moves.

The torque at that instant is the static friction. The instant is found by least squares: the
position is a line before it and a smooth rise after it, so that neither a velocity threshold nor
the delay of a filter shifts it along the ramp. Creep in presliding is the slope of the line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.fitting.protocols.rests import (
    FEWEST,
    Rest,
    is_measured,
    rests,
    still_speed,
    torque_noise,
)
from stribeck.identify.errors.covariance import correlation_length
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: The torque rises during the rest by at least this share of the breakaway torque ...
_RISE = 0.3
#: ... and by this many standard deviations of its noise.
_CLEAR = 6.0
#: It is known to a tenth, and the joint rests this long before it, s: it does not only turn round.
_SIGMAS, _SHORTEST = 10.0, 0.1
#: Over the last part of the rest, a line leaves at most this share of the torque's rise.
_STRAIGHT = 0.15
#: The torque around the instant: within so many of its errors, and in at least so many samples. It
#: changes faster than on the ramp by more than so many standard errors.
_NEAR, _AROUND, _BENDS = 2.0, 4, 2.0
#: The motion is followed until it is this many times as fast as noise looks.
_FAST = 12.0
#: Least samples before the breakaway if the rest has them, and most on either side.
_BEFORE, _MOST = 80, 400
#: Breakaways from which a dependence is read; columns that are alike to this share.
_ENOUGH, _ALIKE = 5, 0.05
#: Instants that are tried, coarsely and then finely.
_TRIED = 80


@dataclass(frozen=True)
class Breakaway:
    """One breakaway.

    Attributes
    ----------
    time
        s; of the instant at which the joint begins to slide.
    time_stderr
        s.
    torque, stderr
        Torque at that instant without the load where it is known, in the unit of torque: the
        static friction, with the sign of the motion.
    rate
        Of the torque, per s.
    dwell
        Time at rest before it, s.
    row
        The first sample that clearly moves.
    rows
        Samples that it is found from.
    """

    time: float
    time_stderr: float
    torque: float
    stderr: float
    rate: float
    dwell: float
    row: int
    rows: int


def breakaways(recording: Recording) -> tuple[Breakaway, ...]:
    """The breakaways of a recording, in order of time; empty where there is none.

    Parameters
    ----------
    recording : Recording
        Sampled in time. Without a load torque, gravity is part of the torque: average both
        directions.

    Examples
    --------
    >>> [b.torque for b in breakaways(sb.read("ramps.csv"))]  # doctest: +SKIP
    [4.98, -5.03, 5.01]
    """
    if recording.averaged:
        return ()
    found = [_breakaway(recording, rest) for rest in rests(recording)]
    return tuple(b for b in found if b is not None)


def _breakaway(recording: Recording, rest: Rest) -> Breakaway | None:
    """The breakaway at the end of a rest; None if the torque was not ramped."""
    speed = np.abs(recording.velocity_smooth[rest.stop : rest.end])
    fast = np.flatnonzero(speed > _FAST * still_speed(recording))
    after = int(fast[0]) if fast.size else speed.size
    after = min(max(after, FEWEST), _MOST, rest.end - rest.stop)
    before = min(rest.stop - rest.start, max(3 * after, _BEFORE), _MOST)
    rows = slice(rest.stop - before, rest.stop + after)
    time = recording.time[rows]
    signal, first = recording.velocity[rows], 2
    if is_measured(recording) and recording.position is not None:
        signal, first = recording.position[rows], 3
    found = _searched(time, signal, (first, first + 1))
    if found is None or not time[FEWEST] < found[0] < time[-FEWEST // 2]:
        return None
    # What is no ramp with the smaller error is none with the larger.
    if _ramped(recording, rest, rows, *found) is None:
        return None
    error = _onset_error(time, signal, found, first)
    return None if error is None else _ramped(recording, rest, rows, found[0], error)


def _ramped(
    recording: Recording, rest: Rest, rows: slice, instant: float, error: float
) -> Breakaway | None:
    """The torque of a ramp at an instant; None where there is no ramp towards the motion."""
    load = recording.known_torque
    own = recording.torque - load
    noise = torque_noise(recording)
    inside = slice(rest.start, rest.stop)
    at = recording.time[rows]
    kept = at <= instant
    t, y = at[kept] - instant, own[rows][kept]
    if t.size < FEWEST:
        return None
    line = np.column_stack([np.ones(t.size), t])
    level, rate = (float(x) for x in linear.least_norm(line, y))
    residual = y - line @ np.array([level, rate])
    # Over the whole rest: the torque comes from elsewhere.
    lowest = float(np.min(rest.direction * own[inside]))
    rise = rest.direction * level - lowest
    towards = rest.direction * level > 0.0 and rest.direction * rate > 0.0
    enough = rise > max(_RISE * abs(level), _CLEAR * noise)
    scatter = float(np.sqrt(np.mean(residual**2)))
    straight = scatter < max(_STRAIGHT * rise, 2.0 * noise)
    if not (towards and enough and straight):
        return None
    independent = max(t.size / correlation_length(residual), 2.0)
    spread = max(float(t.var()), 1e-300)
    own_error = scatter * float(np.sqrt((1.0 + t.mean() ** 2 / spread) / independent))
    fastest = max(abs(rate), _rate_around(at - instant, own[rows], error))
    stderr = float(np.hypot(own_error, fastest * error))
    dwell = instant - float(recording.time[rest.start])
    if abs(level) < _SIGMAS * stderr or dwell < _SHORTEST:
        return None
    return Breakaway(
        time=instant,
        time_stderr=error,
        torque=level,
        stderr=stderr,
        rate=rate,
        dwell=dwell,
        row=rest.stop,
        rows=rows.stop - rows.start,
    )


def _rate_around(t: Array, y: Array, error: float) -> float:
    """How fast the torque changes within the error of the instant, per s; 0 if it hardly does.

    Where a move begins, the torque leaves the ramp before the joint slides.
    """
    near = np.abs(t) <= max(_NEAR * error, float(np.sort(np.abs(t))[_AROUND]))
    line = np.column_stack([np.ones(near.sum()), t[near]])
    level, rate = (float(x) for x in linear.least_norm(line, y[near]))
    residual = y[near] - line @ np.array([level, rate])
    freedom = max(near.sum() - 2, 1)
    uncertain = float(np.sqrt(residual @ residual / freedom / near.sum() / t[near].var()))
    return max(abs(rate) - _BENDS * uncertain, 0.0)


def _onset_error(
    time: Array, signal: Array, found: tuple[float, float], first: int
) -> float | None:
    """Standard error of the instant at which a motion begins, s; None with too few samples.

    While the torque rises in a straight line, the acceleration does so from zero: the position
    begins with the third power of time, its `first`, and the velocity with the second. Whether the
    next one or two powers are taken into account should not matter: what they disagree by is part
    of the error.

    Parameters
    ----------
    found
        The instant with two powers, and its standard error, s.
    """
    three = _searched(time, signal, (first, first + 1, first + 2))
    if three is None:
        return None
    hidden = _hidden(time, signal, found[0], (first, first + 1))
    return float(np.linalg.norm([found[1], found[0] - three[0], hidden]))


def _hidden(time: Array, signal: Array, instant: float, powers: tuple[int, ...]) -> float:
    """Time from the instant until the motion is as large as the noise, s."""
    (matrix,) = _regressors(time, np.array([instant]), powers)
    solution = linear.least_norm(matrix, signal)
    noise = float(np.sqrt(np.mean((signal - matrix @ solution) ** 2)))
    rise = np.abs(matrix[:, 4:] @ solution[4:])
    seen = np.flatnonzero((rise > noise) & (time > instant))
    return float(time[seen[0]] - instant) if seen.size else float(time[-1] - instant)


def _searched(time: Array, signal: Array, powers: tuple[int, ...]) -> tuple[float, float] | None:
    """The instant with the least squares, and its standard error by their rise, s."""
    freedom = time.size - 5 - len(powers)
    if freedom < 3:
        return None
    tried = np.linspace(time[2], time[-3], _TRIED)
    best = int(np.argmin(_squares(time, signal, tried, powers)))
    tried = np.linspace(tried[max(best - 2, 0)], tried[min(best + 2, _TRIED - 1)], _TRIED)
    squares = _squares(time, signal, tried, powers)
    best = int(np.argmin(squares))
    quantile = float(scipy.special.fdtri(1, freedom, 0.6827))
    near = np.flatnonzero(squares <= squares[best] * (1.0 + quantile / freedom))
    width = 0.5 * float(tried[near[-1]] - tried[near[0]])
    return float(tried[best]), max(width, float(tried[1] - tried[0]))


def _squares(time: Array, signal: Array, instants: Array, powers: tuple[int, ...]) -> Array:
    """Sum of squares of a line before each of `instants` and a rise after it, [k]."""
    matrices = _regressors(time, instants, powers)
    residuals = [signal - matrix @ linear.least_norm(matrix, signal) for matrix in matrices]
    return np.array([residual @ residual for residual in residuals])


def _regressors(time: Array, instants: Array, powers: tuple[int, ...]) -> Array:
    """Columns of a line before each of `instants` [k] and of powers of time after it, [k, n, p]."""
    along = (time - instants[:, None]) / (time[-1] - time[0])
    before, after = np.minimum(along, 0.0), np.maximum(along, 0.0)
    # Creep in presliding goes faster towards the breakaway.
    creep = [np.ones_like(along), along, before**2, before**4]
    return np.stack([*creep, *(after**power for power in powers)], axis=-1)


@dataclass(frozen=True)
class Dependence:
    """How static friction depends on the dwell time or on the rate of the torque.

    Attributes
    ----------
    slope
        Rise of its size per tenfold dwell time or rate, in the unit of torque; None if the
        breakaways do not tell it.
    low, high
        Interval of 95 %.
    why
        Why it cannot be told.
    """

    slope: float | None
    low: float | None
    high: float | None
    why: str | None = None


def dependence(found: tuple[Breakaway, ...]) -> dict[str, Dependence]:
    """How the static friction of breakaways depends on ``dwell`` and ``rate``, both at once.

    Its size is a straight line over the logarithms of both, with a level for each direction.

    Examples
    --------
    >>> dependence(())["dwell"].why
    'there are 0 breakaways, at least 5 are needed'
    """
    columns = {
        "dwell": np.log10([b.dwell for b in found]) if found else np.zeros(0),
        "rate": np.log10([abs(b.rate) for b in found]) if found else np.zeros(0),
    }
    if len(found) < _ENOUGH:
        why = f"there are {len(found)} breakaways, at least {_ENOUGH} are needed"
        return {name: Dependence(None, None, None, why) for name in columns}
    # A factor of three apart, or the slope is that of the scatter.
    used = [name for name, x in columns.items() if np.ptp(x) > np.log10(3.0)]
    signs = np.sign([b.torque for b in found])
    levels = [(signs == s).astype(float) for s in (-1.0, 1.0) if (signs == s).any()]
    matrix = np.column_stack([*levels, *(columns[name] - columns[name].mean() for name in used)])
    made = {
        name: Dependence(None, None, None, f"the {name}s differ by less than a factor of 3")
        for name in columns
        if name not in used
    }
    slopes = _slopes(matrix, np.abs([b.torque for b in found]), len(levels))
    for name, (slope, reach) in zip(used, slopes or [], strict=False):
        made[name] = Dependence(slope, slope - reach, slope + reach)
    for name in used:
        made.setdefault(name, Dependence(None, None, None, "dwell and rate change together"))
    return {name: made[name] for name in columns}


def _slopes(matrix: Array, size: Array, levels: int) -> list[tuple[float, float]] | None:
    """Slopes after the levels and half their intervals; None if the columns are alike."""
    values, vectors = linear.singular(matrix)
    freedom = matrix.shape[0] - matrix.shape[1]
    if freedom < 1 or values[matrix.shape[1] - 1] < _ALIKE * values[0]:
        return None
    solution = linear.least_norm(matrix, size)
    residual = size - matrix @ solution
    inverse = (vectors.T / values**2) @ vectors
    errors = np.sqrt(np.diag(inverse) * float(residual @ residual) / freedom)
    reach = float(scipy.special.stdtrit(freedom, 0.975))
    return [(float(solution[k]), reach * float(errors[k])) for k in range(levels, matrix.shape[1])]

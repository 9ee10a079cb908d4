"""How late the torque is, from the recording alone.

Shifted back by that, it is best explained by the motion: by any friction of speed, position and
temperature and by the load.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.effect.columns import displacement_since_reversal
from stribeck.identify.left_out.transients import flexible_columns, of_one_size
from stribeck.identify.scaling import scale_values
from stribeck.models.catalog import catalog
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Relative fall of the RMS error with the best shift, below which the torque is in time.
LEAST = 0.1
#: Most samples looked at.
ROWS = 8000
#: Shifts to each side that are tried; between them where there are more.
SHIFTS = 50
#: Distances over which friction may build up, as in presliding, as shares of the longest move. Such
#: friction looks like a torque that is late.
DISTANCES = (0.003, 0.01, 0.03, 0.1, 0.3)


def torque_shift(recording: Recording) -> int:
    """Samples by which the torque lags the motion; negative where it leads, 0 where neither shows.

    It is searched within the bounds of the effect `delay`.
    """
    return int(_remembered(recording)["samples"])


def is_delayed(recording: Recording) -> bool:
    """Whether beyond the shift the error rises as it falls up to it, as it does behind a delay.

    Presliding, or a load torque behind a filter, have a minimum too, but a wide one.
    """
    return bool(_remembered(recording)["is_delay"])


def _remembered(recording: Recording) -> dict[str, float]:
    """The shift in samples, and whether it is that of a delay (0 or 1); searched once."""
    if "torque_shift" not in recording.remembered:
        shift, is_delay = _searched(recording)
        recording.remembered["torque_shift"] = {"samples": shift, "is_delay": is_delay}
    return recording.remembered["torque_shift"]


def with_shift(start: Array, unknown: Bools, model: Model, recording: Recording) -> Array:
    """A start [p] of a search with the shift of the torque as its delay, where that is unknown.

    The error has a minimum near each sample: from a delay of zero a search ends at one of these.
    A start that a user gave stands.
    """
    is_delay = unknown & np.array([name == "delay" for name in model.names], dtype=bool)
    if not is_delay.any() or "delay" in model.stated.starts:
        return start
    return np.where(is_delay, torque_shift(recording) / (recording.rate_hz or 1.0), start)


def _searched(recording: Recording) -> tuple[int, bool]:
    """The shift with the least error, if that is much less than without; whether it is a delay."""
    r = recording
    if r.averaged or r.rate_hz <= 0.0:
        return 0, False
    delay = catalog()["effects"]["delay"]["parameters"][0]
    reach = math.ceil(delay["upper"] * scale_values(r)[delay["scale"]] * r.rate_hz)
    rows = _sliding(r, reach)
    columns = of_one_size([*flexible_columns(r), *_building_up(r)], r.moving)
    if rows.size < 10 * columns.shape[1]:
        return 0, False
    rows = rows[:: -(-rows.size // ROWS)]
    columns, known = columns[rows], r.known_torque[rows, None]
    step = -(-reach // SHIFTS)
    shifts = step * np.arange(-(reach // step), reach // step + 1)
    errors = linear.squares_left(columns, r.torque[rows[:, None] + shifts] - known)
    without, best = errors[shifts == 0][0], int(shifts[np.argmin(errors)])
    near = np.arange(max(best - step + 1, -reach), min(best + step, reach + 1))
    errors = linear.squares_left(columns, r.torque[rows[:, None] + near] - known)
    best = int(near[np.argmin(errors)])
    # At the end of the range the error may fall further: what causes that is no shift.
    if errors.min() >= (1.0 - LEAST) ** 2 * without or abs(best) >= reach:
        return 0, False
    # The shift is known to half a sample, so that twice of it is known to one.
    beyond = 2 * best + int(np.sign(best))
    if abs(beyond) > reach:
        return best, False
    (after,) = linear.squares_left(columns, r.torque[rows + beyond, None] - known)
    return best, bool(after >= without)


def _sliding(recording: Recording, reach: int) -> NDArray[np.intp]:
    """Samples around which the joint moves in one direction, for `reach` samples to each side."""
    moving, sign = recording.moving, np.sign(recording.velocity)
    changes = ~moving
    changes[1:] |= (sign[1:] != sign[:-1]) | (recording.segment[1:] != recording.segment[:-1])
    before = np.concatenate([[0], np.cumsum(changes)])
    rows = np.arange(reach, moving.size - reach)
    return rows[before[rows + reach + 1] == before[rows - reach + 1]]


def _building_up(recording: Recording) -> list[Array]:
    """Friction that builds up after a reversal, over several distances, arrays [n]."""
    travel = displacement_since_reversal(recording)
    longest = float(travel.max()) or 1.0
    sign = np.sign(recording.velocity)
    return [sign * np.exp(-travel / (share * longest)) for share in DISTANCES]

"""Rows that a logger repeated or left at zero: they are left out."""

from __future__ import annotations

import numpy as np
import scipy

from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.channels import Channels
from stribeck.recording.rows import quantisation_step

__all__ = ["drop_bad_rows"]

#: From this share on, rows are no exception: the file is as it was meant.
_FEW = 0.05
_MEASURED = ("position", "velocity", "torque", "current", "friction_torque")
_EFFORTS = ("torque", "current", "friction_torque")
#: A joint at this many steps of its position per sample cannot stay where it is.
_STEPS = 3.0
#: A clipped torque stands at its limit this often in a row, and this many times as often in all
#: as it is near it.
_IN_A_ROW, _PILE = 3, 10.0
#: The share of the range, from a limit on, that counts as near it.
_NEAR = 0.02


def drop_bad_rows(data: Channels, run: Ints) -> Ints:
    """Leave out rows that hold no measurement; returns the runs of the rows left.

    These are rows of zeros in the middle of a motion, rows that repeat the row before while the
    joint moves, torques that stand alone far outside of all others, and torques clipped at the
    limit of a sensor. Each kind is left out, with a note, if there are few of it.
    """
    if data.prepared.settings.average or len(run) < 20:
        return run
    kinds = {
        "hold zeros in the middle of a motion (drop-outs)": _zeros,
        "repeat the row before while the joint moves": _stuck,
        "have a torque that stands alone outside of all others (spikes)": _spikes,
        "have a torque at the limit of its range (clipped)": _clipped,
    }
    for what, find in kinds.items():
        bad = find(data)
        count = int(bad.sum())
        if not count:
            continue
        if count > _FEW * len(run):
            data.notes.append(f"{count} of {len(run)} rows {what}: too many to leave out")
            continue
        at = int(np.flatnonzero(bad)[0])
        verb = what if count > 1 else _singular(what)
        data.notes.append(
            f"{count} of {len(run)} rows {verb} and {'are' if count > 1 else 'is'} left out "
            f"(first {data.place(at)})"
        )
        data.join(~bad)
        run = run[~bad]
    return run


def _singular(what: str) -> str:
    verb, rest = what.split(" ", 1)
    return f"{ {'have': 'has'}.get(verb, verb + 's') } {rest}"


def _measured(data: Channels) -> dict[str, Floats]:
    return {c: data.values[c] for c in _MEASURED if c in data.values}


def _effort(data: Channels) -> Floats | None:
    return next((data.values[c] for c in _EFFORTS if c in data.values), None)


def _zeros(data: Channels) -> Bools:
    """Rows in which every measured channel is zero, and the position was not nearby."""
    channels = _measured(data)
    none = np.zeros(len(data.rows), dtype=bool)
    position = channels.get("position")
    if position is None or len(channels) < 2:
        return none
    zero = np.all([values == 0.0 for values in channels.values()], axis=0)
    if not zero.any() or zero.all():
        return none
    step = np.abs(np.diff(position))[~(zero[1:] | zero[:-1])]
    away = scipy.ndimage.maximum_filter(np.abs(np.where(zero, 0.0, position)), 5)
    return zero & (away > 5.0 * step.max(initial=0.0))


def _stuck(data: Channels) -> Bools:
    """Rows that are equal to the row before although the joint was moving."""
    channels = _measured(data)
    stuck = np.zeros(len(data.rows), dtype=bool)
    position, time = channels.get("position"), data.values.get("time")
    if position is None or time is None or len(channels) < 2:
        return stuck
    same = np.all([np.diff(values) == 0.0 for values in channels.values()], axis=0)
    if not same.any():
        return stuck
    dt = np.diff(time)
    velocity = channels.get("velocity")
    if velocity is None:
        # The motion over the stretch that holds, seen from the samples around it.
        usual = np.where(same, np.nan, np.abs(np.diff(position)))
        moved = np.fmin(_before(usual), _before(usual[::-1])[::-1])
    else:
        moved = np.abs(velocity[1:]) * dt
    least = _STEPS * quantisation_step(position)
    least = max(least, 1e-9 * float(np.ptp(position)))
    stuck[1:] = same & (moved > least)
    return stuck


def _before(values: Floats) -> Floats:
    """Each value, or the last one before it that is not missing."""
    at = np.maximum.accumulate(np.where(np.isnan(values), -1, np.arange(len(values))))
    return np.where(at >= 0, values[np.maximum(at, 0)], 0.0)


def _spikes(data: Channels) -> Bools:
    """One or two samples of torque that leave the range of all others by more than that range."""
    torque = _effort(data)
    if torque is None:
        return np.zeros(len(data.rows), dtype=bool)
    low, high = np.quantile(torque, [0.001, 0.999])
    away = np.abs(torque - scipy.ndimage.median_filter(torque, 7, mode="nearest"))
    outside = (torque > high + (high - low)) | (torque < low - (high - low))
    return np.asarray(outside & (away > high - low))


def _clipped(data: Channels) -> Bools:
    """Samples of a torque that stand at the largest or smallest value, in rows and piled up.

    A torque that is not clipped is seldom at its largest value, and less often there than just
    below it. A voltage or a duty cycle is what the drive applied, at its limit too.
    """
    torque = _effort(data)
    bad = np.zeros(len(data.rows), dtype=bool)
    unit = next((data.units.get(c, "") for c in _EFFORTS if c in data.values), "")
    if torque is None or unit in ("V", "%") or data.prepared.settings.drive is not None:
        return bad
    span = float(np.ptp(torque))
    for limit in (float(torque.max()), float(torque.min())):
        at = torque == limit
        beside = (np.abs(torque - limit) < _NEAR * span) & ~at
        levels = np.unique(torque[beside]).size
        if levels < 2 or not _rows_of(at, _IN_A_ROW).any():
            continue
        if at.sum() > _PILE * beside.sum() / levels and at.sum() > 2 * _IN_A_ROW:
            bad |= at
    return bad


def _rows_of(mask: Bools, count: int) -> Bools:
    """Where `count` samples in a row hold."""
    held = mask.copy()
    for k in range(1, count):
        held[:-k] &= mask[k:]
        held[-k:] = False
    return held

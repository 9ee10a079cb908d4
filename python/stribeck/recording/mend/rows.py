"""Rows that a logger repeated or left at zero: they are left out."""

from __future__ import annotations

import numpy as np
import scipy

from stribeck.base.errors import RecordingError
from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.joint.channels import Channels
from stribeck.recording.mend.held import Held

__all__ = ["drop_bad_rows"]

#: Rows with values of their own, of which nothing is asked in a shorter file.
_NEEDED = 20
#: From this share on, rows are no exception: the file is as it was meant.
_FEW = 0.05
#: A torque at its limit for longer than that is what the joint is driven with.
_HALF = 0.5
_EFFORTS = ("torque", "current", "friction_torque")
#: A clipped torque stands at its limit this often in a row, and this many times as often in all
#: as it is near it.
_IN_A_ROW, _PILE = 3, 10.0
#: The share of the range, from a limit on, that counts as near it.
_NEAR = 0.02


def drop_bad_rows(data: Channels, run: Ints) -> Ints:
    """Leave out rows that hold no measurement; returns the runs of the rows left.

    These are rows of zeros in the middle of a motion, rows that repeat the row before while the
    joint moves, torques that stand alone far outside of all others, and torques clipped at the
    limit of a sensor. Each kind is left out, with a note, if there are few of it; clipped rows up
    to half of all, and repeated ones however many.

    Raises
    ------
    RecordingError
        Nearly all rows repeat the row before.
    """
    if data.prepared.settings.average or len(run) < _NEEDED:
        return run
    run = _left_out(data, run, _zeros(data), "hold zeros in the middle of a motion (drop-outs)")
    run = _without_held(data, run)
    spikes = "have a torque that stands alone outside of all others (spikes)"
    run = _left_out(data, run, _spikes(data), spikes)
    clipped = "have a torque at the limit of its range (clipped)"
    return _left_out(data, run, _clipped(data), clipped, most=_HALF)


def _left_out(data: Channels, run: Ints, bad: Bools, what: str, most: float = _FEW) -> Ints:
    """The runs of the rows that are not `bad`, which are left out up to a share of them."""
    count = int(bad.sum())
    if not count:
        return run
    if count > most * len(run):
        data.notes.append(f"{count} of {len(run)} rows {what}: too many to leave out")
        return run
    at = int(np.flatnonzero(bad)[0])
    verb = what if count > 1 else _singular(what)
    data.notes.append(
        f"{count} of {len(run)} rows {verb} and {'are' if count > 1 else 'is'} left out "
        f"(first {data.place(at)})"
    )
    data.join(~bad)
    return run[~bad]


def _without_held(data: Channels, run: Ints) -> Ints:
    """The runs of the rows with new values, however many repeat the row before."""
    held = Held.of(data)
    if not held.always:
        return _left_out(data, run, held.rows, "repeat the row before while the joint moves")
    if held.rows.sum() > len(run) - _NEEDED:
        raise RecordingError(
            f"{data.path}: {int(held.rows.sum())} of {len(run)} rows repeat the row before while "
            f"the joint moves: the channels were hardly updated; record again"
        )
    written, changed = (
        1e3 * float(np.median(np.diff(data.values["time"][kept])))
        for kept in (slice(None), ~held.rows)
    )
    data.notes.append(
        f"{int(held.rows.sum())} of {len(run)} rows repeat the row before and are left out: a row "
        f"was written every {written:.3g} ms, and the channels change about every {changed:.3g} ms"
    )
    data.join(~held.rows)
    return run[~held.rows]


def _singular(what: str) -> str:
    verb, rest = what.split(" ", 1)
    return f"{ {'have': 'has'}.get(verb, verb + 's') } {rest}"


def _effort(data: Channels) -> Floats | None:
    return next((data.values[c] for c in _EFFORTS if c in data.values), None)


def _zeros(data: Channels) -> Bools:
    """Rows in which every measured channel is zero, and the position was not nearby."""
    channels = data.measured
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

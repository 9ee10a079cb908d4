"""Samples that are excluded from every fit, and what a reader has to know of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base.memo import Memo
from stribeck.identify.left_out.late_torque import friction_of_rest, friction_of_slow_motion
from stribeck.identify.left_out.torque_shift import torque_shift
from stribeck.identify.left_out.transients import stretches, transient_rows
from stribeck.identify.left_out.uncertain_direction import late_velocity, uncertain_direction
from stribeck.recording.recording import Recording

Bools = NDArray[np.bool_]

_SCORED: Memo[Recording, Bools] = Memo()


def scored_rows(recording: Recording) -> Bools:
    """Samples that models are judged by, bool [n]: those that move, unless they are in doubt.

    What a model predicts for a sample in doubt, whose direction or friction is unknown because a
    channel is late, may be wrong by twice the dry friction however good the model is. Where all
    would be in doubt, all that move are scored.
    """
    return _SCORED.of(recording, "", lambda: _scored(recording))


def _scored(recording: Recording) -> Bools:
    known = recording.moving & ~_in_doubt(recording)
    return known if known.any() else recording.moving


def counted_rows(recording: Recording) -> Bools:
    """The scored samples that the held-out error counts, bool [n]: those of the marked blocks."""
    scored = scored_rows(recording)
    return scored if recording.counted is None else scored & recording.counted


def rows_left_out(recording: Recording) -> Bools:
    """Moving samples that no model is fitted to, bool [n].

    They are transients, which are scored, or in doubt because a channel is late.
    """
    return transient_rows(recording, _by_direction_or_rest(recording)) | _in_doubt(recording)


def transients(recording: Recording, marked: Bools) -> list[tuple[float, float]]:
    """Start and end times in s of those of the samples `marked` that are transients."""
    return stretches(recording, marked & ~_in_doubt(recording))


def left_out_notes(recording: Recording, marked: Bools) -> tuple[str, ...]:
    """What a reader has to know of the samples `marked` as left out."""
    notes = (*_of_late_velocity(recording, marked), *_of_late_torque(recording, marked))
    found = transients(recording, marked)
    if not found:
        return notes
    spans = ", ".join(f"{a:.1f}-{b:.1f} s" for a, b in found)
    return (
        *notes,
        f"friction models fitted to the rest do not explain the motion at {spans} (an approach "
        f"move, an abrupt stop, or a motion unlike the rest): scored, but excluded from the fit",
    )


def _in_doubt(recording: Recording) -> Bools:
    return _by_direction_or_rest(recording) | friction_of_slow_motion(recording)


def _by_direction_or_rest(recording: Recording) -> Bools:
    return uncertain_direction(recording) | friction_of_rest(recording)


def _of_late_velocity(recording: Recording, marked: Bools) -> tuple[str, ...]:
    late = late_velocity(recording)
    if late is None:
        return ()
    count = int(np.count_nonzero(marked & uncertain_direction(recording)))
    if not count:
        return ()
    return (
        f"the recorded velocity lags the position by {1e3 * late.lag:.3g} ms "
        f"({late.lag * recording.rate_hz:.2g} samples), as behind a filter: the direction of "
        f"{count} samples before reversals is uncertain; they are neither fitted nor scored",
    )


def _of_late_torque(recording: Recording, marked: Bools) -> tuple[str, ...]:
    shift = torque_shift(recording)
    way = "lagged behind" if shift > 0 else "led"
    found = (
        (friction_of_rest(recording), "beside a rest may show the friction of that rest"),
        (friction_of_slow_motion(recording), "may show the friction of the reversal beside them"),
    )
    said = [(int(np.count_nonzero(marked & rows)), what) for rows, what in found]
    listed = [f"{count} samples {what}" for count, what in said if count]
    if not listed:
        return ()
    return (
        f"the torque is as if it {way} the motion by about "
        f"{1e3 * abs(shift) / recording.rate_hz:.3g} ms: "
        f"{', and '.join(listed)}; they are neither fitted nor scored",
    )

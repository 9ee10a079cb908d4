"""What is said of a recording: its name, its scored samples, what "held-out" means on it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from stribeck.base.errors import joint_called
from stribeck.identify.left_out.rows import scored_rows
from stribeck.report.numbers import percent, plain, thousands

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit
    from stribeck.recording.check import Check
    from stribeck.recording.recording import Recording

#: Names of the regimes.
REGIMES = {
    "reversal": "within 0.2 s of a reversal",
    "low_speed": "slowest quarter",
    "high_speed": "fastest quarter",
    "forward": "moving forward (v > 0)",
    "backward": "moving backward (v < 0)",
    "motoring": "motoring (torque along v)",
    "generating": "braking (torque against v)",
    "cold": "coldest quarter",
    "hot": "warmest quarter",
    "start": "first quarter of the time",
    "end": "last quarter of the time",
    "drive_on": "drive on",
    "drive_off": "drive off",
    "standstill": "at rest (not scored)",
}


def recording_text(r: Recording) -> str:
    """A recording in one line."""
    joint = f", {joint_called(r.joint)}" if r.joint else ""
    return (
        f"<Recording {Path(r.path).name}{joint}: {r.rows} rows, {r.runs} run"
        f"{'s' if r.runs > 1 else ''}, {r.rate_hz:.4g} Hz, {r.joint_kind}, {r.torque_unit}>"
    )


def file_name(recording: Recording) -> str:
    """The recording's file, and its joint where it has a name."""
    name = Path(recording.path).name
    return f"{name}, {joint_called(recording.joint)}" if recording.joint else name


def state_of(check: Check) -> Literal["ok", "open", "wrong"]:
    """``"ok"``, ``"wrong"``, or ``"open"`` where nothing can be concluded."""
    if check.is_open:
        return "open"
    return "ok" if check.ok else "wrong"


def scored_sentence(r: Recording) -> str:
    """Which samples are scored, in one sentence."""
    scored = r.scored(scored_rows(r))
    if r.velocity_threshold == 0.0:
        return f"All {thousands(r.time.size)} samples are scored, moving or not."
    by_noise = math.isclose(r.velocity_threshold, 5.0 * r.velocity_noise, rel_tol=1e-6)
    why = ", five times the noise of the velocity" if by_noise else ""
    doubtful = int(r.moving.sum()) - int(scored["rows"])
    without = f", without {thousands(doubtful)} in doubt" if doubtful else ""
    return (
        f"{thousands(int(scored['rows']))} of {thousands(r.time.size)} samples are scored "
        f"({percent(scored['share'])}): those moving faster than "
        f"{plain(r.velocity_threshold, 2)} {r.position_unit}/s{why}{without}."
    )


def held_out_meaning(fit: Fit) -> str:
    """What "held-out" means for a model on its recording."""
    if fit.outcome == "not refitted":
        return "the model is taken as it is, nothing is fitted"
    return blocks_meaning(fit.recording)


def blocks_meaning(r: Recording) -> str:
    """What "held-out" means for models that are fitted to a recording."""
    if r.runs >= 5 and r.block_count == r.runs:
        part = "run"
    elif r.block_count == 10:
        part = "tenth"
    else:
        part = f"of {r.block_count} blocks"
    return f"each {part} is predicted by a model fitted without it"

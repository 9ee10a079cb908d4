"""What the methods' results look like on a terminal."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.report.numbers import percent, plain, with_error
from stribeck.report.text import file_name, notes_text, table

if TYPE_CHECKING:
    from stribeck.fitting.methods.arm import ArmFit
    from stribeck.fitting.methods.steady import SteadyPoints


def points_text(points: SteadyPoints) -> str:
    """Steady-state friction points, one line each."""
    r = points.recording
    heading = ["point", "from [s]", f"velocity [{r.position_unit}/s]", "",
               f"friction [{r.torque_unit}]", ""]  # fmt: skip
    with_load = any(p.load_torque is not None for p in points.points)
    with_temperature = any(p.temperature is not None for p in points.points)
    heading += [f"load [{r.torque_unit}]"] * with_load + ["T [degC]"] * with_temperature
    rows = [heading]
    for k, p in enumerate(points.points, 1):
        velocity, velocity_error = with_error(p.velocity, p.velocity_stderr)
        friction, friction_error = with_error(p.friction_torque, p.friction_stderr)
        row = [str(k), f"{p.start:.1f}", velocity, f"± {velocity_error}",
               friction, f"± {friction_error}"]  # fmt: skip
        row += [plain(p.load_torque or 0.0)] * with_load
        row += [plain(p.temperature or 0.0)] * with_temperature
        rows.append(row)
    head = f"{len(points)} steady-state points by {points.method} from {file_name(r)}"
    right = [0, 1, 2, 4, *range(6, len(heading))]
    return "\n\n".join([head, table(rows, right=right), notes_text(r.notes, points.notes)])


def arm_text(arm: ArmFit) -> str:
    """Inertia and friction of an arm, with what is left of the torques."""
    rows = [["parameter", "symbol", "value", "error", "unit", "what it is"]]
    for p in arm.parameters:
        value, error = with_error(p.value, p.stderr)
        rows.append([p.name, p.symbol, value, f"± {error}", p.unit, p.description])
    errors = [
        f"  joint {k}: torque error {percent(error)} of the measured torque (RMS, all rows), "
        f"fitted to {used} rows"
        for k, (error, used) in enumerate(zip(arm.relative_errors, arm.rows, strict=True), 1)
    ]
    head = (
        f"planar two-joint arm from {Path(arm.recordings[0].path).name}, "
        f"first link {plain(arm.first_link_length)} m"
    )
    notes = notes_text(arm.recordings[0].notes, arm.recordings[1].notes)
    return "\n\n".join([head, table(rows, right=(2,)), "\n".join(errors), notes])

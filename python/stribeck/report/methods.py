"""Results of the identification methods as text."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.report.layout import joined, notes_text, table
from stribeck.report.numbers import percent, plain, thousands, unit_text, with_error
from stribeck.report.recording import file_name

if TYPE_CHECKING:
    from stribeck.fitting.methods.arm import ArmFit
    from stribeck.fitting.methods.steady import SteadyPoints
    from stribeck.fitting.protocols.points import BristleStiffness


def points_text(points: SteadyPoints) -> str:
    """Steady-state friction points, one line each."""
    r = points.recording
    velocity, friction = f"velocity [{r.position_unit}/s]", f"friction [{r.torque_unit}]"
    heading = ["point", "from [s]", velocity, "", friction, ""]
    with_load = any(p.load_torque is not None for p in points.points)
    with_temperature = any(p.temperature is not None for p in points.points)
    heading += [f"load [{r.torque_unit}]"] * with_load + ["T [degC]"] * with_temperature
    rows = [heading]
    for k, p in enumerate(points.points, 1):
        v, v_error = with_error(p.velocity, p.velocity_stderr)
        f, f_error = with_error(p.friction_torque, p.friction_stderr)
        row = [str(k), f"{p.start:.1f}", v, f"± {v_error}", f, f"± {f_error}"]
        row += [plain(p.load_torque or 0.0)] * with_load
        row += [plain(p.temperature or 0.0)] * with_temperature
        rows.append(row)
    return joined(
        f"{len(points)} steady-state points by {points.method} from {file_name(r)}",
        table(rows, right=[0, 1, 2, 4, *range(6, len(heading))]),
        notes_text(r.notes, points.notes),
    )


def stiffness_text(stiffness: BristleStiffness) -> str:
    """Presliding loops, one line each, and how a fit uses them."""
    r = stiffness.recording
    heading = [
        "loop",
        "from [s]",
        f"torque [{r.torque_unit}]",
        f"position [{r.position_unit}]",
        f"stiffness [{r.torque_unit}/{r.position_unit}]",
        "energy [J]",
    ]
    rows = [heading]
    for k, loop in enumerate(stiffness.loops, 1):
        sizes = (loop.torque_amplitude, loop.amplitude, loop.stiffness, loop.area)
        rows.append([str(k), f"{loop.time:.1f}", *map(plain, sizes)])
    value, error = with_error(stiffness.value, stiffness.stderr)
    return joined(
        f"{len(stiffness.loops)} presliding loops from {file_name(r)}; torque and position are "
        "half amplitudes",
        table(rows, right=[0, 1, 2, 3, 4, 5]),
        f"Stiffness {value} ± {error} {r.torque_unit}/{r.position_unit}. In a fit of a law with a "
        f'bristle:\n  --prior "{stiffness.prior}"',
        notes_text(r.notes, ()),
    )


def arm_text(arm: ArmFit) -> str:
    """Inertia and friction of an arm, and the errors of the torques."""
    rows = [["parameter", "symbol", "value", "error", "unit", "what it is"]]
    for p in arm.parameters:
        value, error = with_error(p.value, p.stderr)
        rows.append([p.name, p.symbol, value, f"± {error}", unit_text(p.unit), p.description])
    errors = [
        f"  joint {k}: torque error {percent(error)} of the measured torque (RMS, all samples), "
        f"fitted to {thousands(used)} samples"
        for k, (error, used) in enumerate(zip(arm.relative_errors, arm.rows, strict=True), 1)
    ]
    errors += [
        f"  {Path(e.file).name}, not fitted: torque error {percent(e.relative_residual[0])} and "
        f"{percent(e.relative_residual[1])} of the measured torques"
        for e in arm.evaluated
    ]
    return joined(
        f"Planar two-joint arm from {Path(arm.recordings[0].path).name}, first link "
        f"{plain(arm.first_link_length)} m",
        table(rows, right=(2,)),
        "\n".join(errors),
        notes_text(arm.recordings[0].notes, arm.recordings[1].notes),
    )

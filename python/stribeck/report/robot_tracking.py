"""Robots in closed loop as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.layout import joined, paragraph, table
from stribeck.report.numbers import percent, plain

if TYPE_CHECKING:
    from stribeck.robot.follow import RobotTracking


def robot_tracking_text(tracked: RobotTracking) -> str:
    """RMS error of every joint in closed loop, one column a compensation."""
    return joined(
        tracking_sentence(tracked),
        table(tracking_rows(tracked), right=range(2, 3 + len(tracked.runs))),
        paragraph(TRACKED, 2),
    )


#: What the columns of `tracking_rows` are.
TRACKED = (
    "RMS of the desired minus the actual position, without compensation of friction and "
    "with the friction of each file at the desired motion. sticks: share of the time at "
    "rest, with the last one."
)


def tracking_sentence(tracked: RobotTracking) -> str:
    """The robot, and how long it moved."""
    seconds, steps = tracked.time[-1], len(tracked.time)
    return f"{tracked.robot.name} in closed loop: {seconds:.3g} s, {steps} steps"


def tracking_rows(tracked: RobotTracking) -> list[list[str]]:
    """RMS error of every joint; the heading first."""
    rows = [["joint", "", *(run.name or "without" for run in tracked.runs), "sticks"]]
    last = tracked.runs[-1]
    for k, joint in enumerate(tracked.robot.joints):
        unit = "mrad" if joint.movement == "revolute" else "mm"
        errors = [plain(1000.0 * float(run.error[k])) for run in tracked.runs]
        rows.append([joint.name, unit, *errors, percent(float(last.sticking[k]))])
    return rows

"""The pages that commands on robots write with `--report`."""

from __future__ import annotations

from stribeck.cli.pages import command_line, save_page
from stribeck.robot.compare import RobotComparison
from stribeck.robot.diagnosis import RobotDiagnosis
from stribeck.robot.improve import RobotImprovement
from stribeck.robot.result import RobotFit


def robot_report(
    found: RobotFit | RobotComparison | RobotDiagnosis | RobotImprovement, path: str | None
) -> None:
    """Write the page of a result; nothing if `path` is None."""
    if path is None:
        return
    # Bokeh is slow to import.
    from stribeck.report.pages.robot import (
        robot_comparison_page,
        robot_diagnosis_page,
        robot_fit_page,
        robot_improvement_page,
    )

    if isinstance(found, RobotImprovement):
        page = robot_improvement_page(found, command_line())
    elif isinstance(found, RobotDiagnosis):
        page = robot_diagnosis_page(found, command_line())
    elif isinstance(found, RobotComparison):
        page = robot_comparison_page(found, command_line())
    else:
        page = robot_fit_page(found, command_line())
    save_page(page, path)

"""Pages on robots: every joint has its section, and nothing is fetched."""

from __future__ import annotations

from stribeck.report.robot_page import (
    robot_comparison_page,
    robot_fit_page,
    robot_improvement_page,
)
from stribeck.robot.compare import compare_robots
from stribeck.robot.fit import fit_robot
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import RobotMotion


def test_a_page_of_a_fit(motion: RobotMotion) -> None:
    page = robot_fit_page(fit_robot(motion), "stribeck robot fit")
    for words in (
        "planar",
        "Joint 1",
        "Joint 2",
        "Rigid bodies",
        "stribeck robot fit",
        "N m s/rad",
    ):
        assert words in page
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert page.count("data:image/png") == 1


def test_a_page_of_models_side_by_side(motion: RobotMotion) -> None:
    compared = compare_robots(motion, ["coulomb", "coulomb+offset"])
    page = robot_comparison_page(compared)
    assert "Models side by side" in page
    assert page.count("<h2>coulomb") == 2


def test_a_page_of_what_is_missing(motion: RobotMotion) -> None:
    page = robot_improvement_page(improve_robot(motion, most_steps=0))
    assert "No effect is added." in page
    assert "What was missing" in page

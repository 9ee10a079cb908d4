"""Pages on robots: every joint has its section, and nothing is fetched."""

from __future__ import annotations

import re

import numpy as np
from stribeck.report.page_figures import robot_plots
from stribeck.report.robot_page import (
    robot_comparison_page,
    robot_diagnosis_page,
    robot_fit_page,
    robot_improvement_page,
)
from stribeck.robot.compare import compare_robots
from stribeck.robot.diagnosis import RobotDiagnosis
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
        '<span class="word">stribeck</span> <span class="word">robot</span> '
        '<span class="word">fit</span>',
        "N m s/rad",
    ):
        assert words in page
    assert not re.search(r"<(script|img|link|iframe)[^>]*(src|href)=[\"']?(http|//)", page)
    for joint in ("1", "2"):
        assert f"<figcaption>Joint {joint}: friction over velocity</figcaption>" in page
        assert f"<figcaption>Joint {joint}: residual over time</figcaption>" in page


def test_joints_share_samples_and_time(motion: RobotMotion) -> None:
    found = fit_robot(motion)
    plots = robot_plots(found)
    sources = {shown.data_source for p in plots.values() for shown in p.renderers[:1]}
    assert len(sources) == 1 and len(plots) == 4
    first, other = (plots[f"Joint {k}: residual over time"] for k in (1, 2))
    assert first.x_range is other.x_range
    data = sources.pop().data
    friction = data["friction_0"] - data["modelled_0"]
    assert np.allclose(friction, data["residual_0"], atol=1e-5, equal_nan=True)
    for plot in plots.values():
        assert "[N m]" in plot.yaxis[0].axis_label and "[" in plot.xaxis[0].axis_label


def test_a_page_of_a_diagnosis(motion: RobotMotion) -> None:
    found = RobotDiagnosis.of(improve_robot(motion, most_steps=0))
    page = robot_diagnosis_page(found, "stribeck robot diagnose")
    assert "What is missing" in page and '<span class="word">diagnose</span>' in page
    for name, joint in found.joints.items():
        assert f"Joint {name}" in page
        for finding in joint.findings:
            assert f"{finding.effect}, " in page


def test_a_page_of_models_side_by_side(motion: RobotMotion) -> None:
    compared = compare_robots(motion, ["coulomb", "coulomb+offset"])
    page = robot_comparison_page(compared)
    assert "Models side by side" in page
    assert page.count("<h2>coulomb") == 2


def test_a_page_of_what_is_missing(motion: RobotMotion) -> None:
    page = robot_improvement_page(improve_robot(motion, most_steps=0))
    assert "No effect is added." in page
    assert "What was missing" in page

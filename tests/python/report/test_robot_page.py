"""Pages on robots: every joint has its section, and nothing is fetched."""

from __future__ import annotations

import re

import numpy as np
from stribeck.report.interactive.base import shown_range
from stribeck.report.interactive.robot_joint import joint_friction
from stribeck.report.interactive.robot_samples import robot_samples
from stribeck.report.pages.figures import robot_plots
from stribeck.report.pages.robot import (
    robot_comparison_page,
    robot_diagnosis_page,
    robot_fit_page,
    robot_improvement_page,
)
from stribeck.report.pages.robot_headline import diagnosis_headline, headline
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
        assert f"<figcaption>Joint {joint}: friction against velocity</figcaption>" in page
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
    assert '<p class="lead">' in page and "joint" in diagnosis_headline(found).lower()
    assert "What is missing" in page and '<span class="word">diagnose</span>' in page
    for name, joint in found.joints.items():
        assert f"Joint {name}" in page
        for finding in joint.findings:
            assert f"{finding.effect}, " in page


def test_a_page_of_models_side_by_side(motion: RobotMotion) -> None:
    compared = compare_robots(motion, ["coulomb", "coulomb+offset"])
    page = robot_comparison_page(compared)
    assert "Models side by side" in page
    lead = page[page.index('<p class="lead">') :].partition("</p>")[0]
    assert "joint" in lead and "held-out" in lead
    # The table stands above the figures, which are of the last model.
    assert page.index("Models side by side") < page.index("<figcaption>")
    assert "Figures show coulomb+offset." in page


def test_a_page_of_what_is_missing(motion: RobotMotion) -> None:
    page = robot_improvement_page(improve_robot(motion, most_steps=0))
    assert "No effect is added." in page
    assert "What was missing" in page


def test_the_headline_is_in_proportion_to_the_confidence() -> None:
    lacking = [("2", "load", 0.999), ("3", "load", 0.97), ("5", "presliding", 0.4)]
    assert headline(lacking, {}, []) == (
        "Joints 2 and 3 lack load (confidence 0.97) and joint 5 perhaps presliding (0.40)."
    )
    more = [*lacking, ("1", "ripple", 0.8), ("4", "stribeck", 0.3)]
    assert headline(more, {}, []).endswith("; 1 more effect is named below.")
    nothing = {"1": "none", "2": "unexplained"}
    assert headline([], nothing, ["a payload in run 2"]) == (
        "No effect is found to be missing from any joint, but structure remains on joint 2; in the "
        "rigid bodies: a payload in run 2."
    )


def test_one_outlier_does_not_stretch_the_axes(motion: RobotMotion) -> None:
    samples = robot_samples(fit_robot(motion))
    before = joint_friction(samples, 0).y_range
    values = samples.source.data["friction_0"]
    known = values[np.isfinite(values)]
    limits = shown_range([np.append(known, 100.0 * known.max())])
    assert limits is not None
    assert limits[1] < 2.0 * before.end and limits[0] > 2.0 * before.start

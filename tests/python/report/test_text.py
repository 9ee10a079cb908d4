"""What the commands print."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.testable import Untestable
from stribeck.recording.check import Check
from stribeck.report import (
    comparison,
    diagnosis,
    fit,
    layout,
    parameters,
)
from stribeck.report import (
    improvement as improving,
)
from stribeck.report.certificate import certificate_text
from stribeck.report.diagnosis import nothing_found, visible_heading
from stribeck.report.numbers import confidence_words, listed, percent, plain, with_error
from stribeck.report.robot import bodies_sentence, found_alone
from stribeck.report.unexplained import left_text
from stribeck.robot.improve import RobotImprovement
from stribeck.robot.result import RobotFit
from synthetic import joint, record


def every_text(improvement: sb.Improvement, steady: sb.Fit) -> dict[str, str]:
    base, final = improvement.base, improvement.final
    compared = sb.compare([base, final], final.recording)
    return {
        "fit": fit.fit_text(final),
        "steady": fit.fit_text(steady),
        "comparison": comparison.comparison_text(compared),
        "diagnosis": diagnosis.diagnosis_text(improvement.last),
        "addition": improving.addition_text(sb.Addition("load", base, final)),
        "improvement": improving.improvement_text(improvement),
    }


def test_no_line_is_wider_than_a_terminal(improvement: sb.Improvement, steady: sb.Fit) -> None:
    for name, shown in every_text(improvement, steady).items():
        for line in shown.splitlines():
            assert len(line) <= layout.WIDTH, (name, line)
            assert line == line.rstrip(), (name, line)


def test_no_number_is_missing(improvement: sb.Improvement, steady: sb.Fit) -> None:
    for name, shown in every_text(improvement, steady).items():
        for word in ("nan", "inf ", "None", "unknown"):
            assert word not in shown, (name, word)


def test_an_improvement_tells_what_was_found(improvement: sb.Improvement) -> None:
    shown = improving.improvement_text(improvement)
    assert [s.finding.effect for s in improvement.steps] == ["load"]
    assert "The model coulomb lacks load" in shown
    assert "N m" in shown
    assert "± " in shown
    assert "the temperature varies by" in shown


def test_bars_are_as_long_as_the_errors() -> None:
    shown = layout.bars(["base", "+ load"], [2.0, 0.5], 0.5, "N m").splitlines()
    assert shown[0].count("█") + shown[0].count("▒") == layout.BAR
    assert shown[1].count("▒") == layout.BAR // 4
    assert "█" not in shown[1]
    assert "75 %" in shown[1]
    assert "noise floor, 0.500 N m" in shown[2]


def test_bars_without_figures() -> None:
    assert "no held-out error" in layout.bars(["base"], [None], None, "N")


def test_wide_tables_are_broken_not_cut() -> None:
    rows = [["name", "value", "size"], ["alpha", "lengthy " * 12, "1.0"], ["beta", "b", "2.0"]]
    lines = layout.table(rows, right=(2,)).splitlines()
    assert max(map(len, lines)) <= layout.WIDTH
    assert " ".join(lines).count("lengthy") == 12
    assert lines[0].split() == ["name", "value", "size"] and set(lines[1].strip()) == {"─"}
    assert lines[2].startswith("  alpha  lengthy") and lines[2].endswith("1.0")
    assert lines[-1].split() == ["beta", "b", "2.0"]


def test_a_table_of_names_and_numbers_alone_is_neither_cut_nor_broken() -> None:
    rows = [["effect", "parameter", "here"], ["e" * 40, "p" * 40, "1" * 40]]
    lines = layout.table(rows, right=(2,), whole=(0, 1)).splitlines()
    assert [row.split() for row in lines if "e" * 40 in row] == [rows[1]]


def test_number_and_unit_stay_together() -> None:
    for length in range(60, 100):
        assert "0.5 N m" in layout.paragraph("a" * length + " 0.5 N m of torque")


def test_ties_are_said(improvement: sb.Improvement) -> None:
    finding = replace(improvement.steps[0].finding, indistinguishable_from=("gravity", "inertia"))
    shown = diagnosis.finding_text(finding)
    assert "Indistinguishable from gravity or inertia on this data" in " ".join(shown.split())


def test_flags_of_parameters(improvement: sb.Improvement) -> None:
    e = improvement.final.estimates["coulomb_friction"]
    top = replace(e, value=e.upper, at_bound=True, stderr=None, ci95=None)
    blind = replace(e, identifiable=False, stderr=None, ci95=None)
    vague = replace(e, name="vague", stderr=e.value)
    flags = [row[-1] for row in parameters.parameter_rows([e, top, blind, vague])]
    assert flags == ["", "at its upper bound", "not identifiable", "poorly determined"]


def test_effects_with_the_same_reason_stand_together() -> None:
    rows = [Untestable("a", "why", "do"), Untestable("b", "why", "do"), Untestable("c", "x", "y")]
    assert diagnosis.untestable_rows(rows) == [("a and b", "why", "do"), ("c", "x", "y")]


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (8.01234, 0.0223, ("8.012", "0.022")),
        (1234.5, 87.0, ("1234", "87")),
        (1e-9, 2e-10, ("1.00e\N{MINUS SIGN}09", "2.0e\N{MINUS SIGN}10")),
        (0.0, 0.01, ("0.000", "0.010")),
        (3.0, None, ("3.000", "")),
        (3.0, float("nan"), ("3.000", "")),
        (0.001, 5.0, ("0.0", "5.0")),
    ],
)
def test_digits_follow_the_error(value: float, error: float | None, shown: tuple[str, str]) -> None:
    assert with_error(value, error) == shown


def test_numbers_as_people_read_them() -> None:
    assert [plain(x) for x in (0.0, 0.1234, 12.34, 1234.0, 1e-9)] == [
        "0",
        "0.123",
        "12.3",
        "1234",
        "1e\N{MINUS SIGN}09",
    ]
    assert [percent(x) for x in (0.0, 0.5, 0.9999, 1.0, 3.0, 1e-5)] == [
        "0 %",
        "50 %",
        "> 99 %",
        "100 %",
        "300 %",
        "< 0.1 %",
    ]
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert confidence_words(0.3) == "possible (confidence 0.30)"


def test_a_bound_that_is_rounding_is_said_to_be() -> None:
    friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    found = sb.check(friction, {"velocity": (-2.0, 2.0)})
    margin = replace(found.margins[0], lower=-6.04e-14)
    assert "0 N m within rounding" in certificate_text(replace(found, margins=(margin,)))
    violated = replace(margin, lower=-6.04e-9)
    assert "-6.04e-09 N m" in certificate_text(replace(found, margins=(violated,)))


def test_what_was_not_found_on_a_prismatic_joint_is_a_force(diagnosis: sb.Diagnosis) -> None:
    assert "RMS torque" in visible_heading(diagnosis)
    model = replace(diagnosis.fit.model, torque_unit="N")
    moved = replace(diagnosis, fit=replace(diagnosis.fit, model=model))
    assert "RMS force" in visible_heading(moved)


def test_an_error_in_excluded_samples_is_said(diagnosis: sb.Diagnosis) -> None:
    r = diagnosis.fit.recording
    assert "Not judged" not in left_text(Unexplained(0.0, None, excluded=0.1), r)
    said = left_text(Unexplained(0.0, None, excluded=0.83), r)
    assert "Not judged are the samples that the fit excludes" in said and "83 %" in said


def test_few_samples_say_little(tmp_path: Path) -> None:
    few = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(rows=150)), starts=1))
    assert few.findings == () and "says little" in nothing_found(few, "coulomb", unexplained=False)
    assert "says little" in diagnosis.diagnosis_text(few)
    many = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(), "many"), starts=1))
    assert "says little" not in nothing_found(many, "coulomb", unexplained=False)


def test_other_joints_that_move_are_said_beside_structure(diagnosis: sb.Diagnosis) -> None:
    others = Check("others", True, "joint 2 moves as well, and what it carries loads this joint")
    r = replace(diagnosis.fit.recording, checks=(others,))
    assert "Joint 2 moves as well" in left_text(Unexplained(0.4, "everywhere"), r)
    assert "Joint 2" not in left_text(Unexplained(0.05, None), r)


def test_an_effect_that_changes_nothing_does_not_raise_the_error_by_zero() -> None:
    t = np.arange(3000) / 100.0
    noise = 0.05 * np.random.default_rng(0).standard_normal(t.size)
    r = sb.Recording.from_columns(time=t, velocity=np.cos(t), torque=np.sign(np.cos(t)) + noise)
    fit = sb.fit("coulomb", r, starts=1)
    text = " ".join(improving.addition_text(sb.Addition("offset", fit, fit)).split())
    assert "rises" not in text and "falls" not in text
    assert "stays at" in text and "the effect does not improve it" in text


def test_a_model_that_explains_nothing_is_said_to(tmp_path: Path) -> None:
    """The torque is that of another cause, and friction is lost in it."""
    frame = joint()
    push = 40.0 * np.sin(3.0 * frame["time"].to_numpy() ** 1.1)
    pushed = frame.drop("load_torque").with_columns(torque=pl.col("torque") + push)
    fitted = sb.fit("coulomb", record(tmp_path, pushed), starts=1)
    assert fitted.relative_residual is not None and fitted.relative_residual > 0.9
    assert "coulomb explains hardly any of the torque" in fit.fit_text(fitted)
    usual = sb.fit("coulomb", record(tmp_path, frame, "usual"), starts=1)
    assert "hardly any" not in fit.fit_text(usual)


def test_a_robot_whose_torque_is_not_explained_says_nothing_of_its_links() -> None:
    def fitted(*relative: float) -> RobotFit:
        joints = [
            SimpleNamespace(joint=f"Joint{k}", relative_residual_held_out=value)
            for k, value in enumerate(relative, 1)
        ]
        motion = SimpleNamespace(cutoff=31.6)
        solved = SimpleNamespace(balance=SimpleNamespace(motion=motion))
        return cast(RobotFit, SimpleNamespace(joints=joints, solved=solved, consistent=True))

    said = bodies_sentence(fitted(1.1, 0.2, 0.95))
    assert "hardly any of the torque of Joint1 and Joint3" in said and "than 31.6 Hz" in said
    assert bodies_sentence(fitted(0.5, 0.2, 0.1)).startswith("Bodies of positive mass density")


def test_what_a_joint_alone_shows_is_listed_when_it_was_not_added() -> None:
    several = tuple(SimpleNamespace(effect=effect) for effect in ("delay", "ripple"))
    joints = {"a": SimpleNamespace(findings=several), "b": SimpleNamespace(findings=())}
    said = found_alone(cast(RobotImprovement, SimpleNamespace(last=joints)))
    assert "not added" in said and said.endswith("joint a: delay or ripple")
    assert found_alone(cast(RobotImprovement, SimpleNamespace(last={}))) == ""

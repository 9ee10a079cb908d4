"""What a fleet's data set says: rows, changes against the scatter, effects of few joints."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from datetime import date
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from fleet_logs import JOINTS, WEAR, WORN
from stribeck.models.catalog import effect_ids, law_ids
from stribeck.motion.generate.motion import GeneratedJoint
from stribeck.motion.generate.plausible import plausible_values
from stribeck.report.interactive.fleet_changes import fleet_changes
from stribeck.report.interactive.fleet_effects import fleet_effects
from stribeck.scale.fleet.changes import Question, find_changes
from stribeck.scale.fleet.effects import find_effects
from stribeck.scale.fleet.friction_at import DayModel, common_conditions, common_speeds
from stribeck.scale.fleet.store import DONE, SCHEMA


def test_a_row_is_what_fit_says(fitted: sb.Fleet, logs: list[Path]) -> None:
    recording = sb.read(logs[0], joint=JOINTS[0])
    alone = sb.fit("coulomb", recording)
    row = fitted.rows.filter(file=str(logs[0]), joint=JOINTS[0]).row(0, named=True)
    assert row["robot"] == "r1" and row["day"] == date(2026, 3, 1) and row["model"] == "coulomb"
    assert row["rmse_held_out"] == alone.rmse_held_out
    for said in row["parameters"]:
        estimate = alone.estimates[said["name"]]
        assert (said["value"], said["stderr"]) == (estimate.value, estimate.stderr)
    covariance = np.reshape(row["covariance"], (2, 2))
    errors = [said["stderr"] for said in row["parameters"]]
    assert np.sqrt(np.diag(covariance)) == pytest.approx(errors, rel=1e-12)
    assert row["noise_floor"] == pytest.approx(0.05, rel=0.3)


def test_the_joint_that_wears_is_the_one_that_changed(fitted: sb.Fleet) -> None:
    changes = fitted.changes
    assert [(j.robot, j.joint) for j in changes.changed] == [WORN]
    assert len(changes.joints) == 6 and changes.since == date(2026, 3, 7)
    worn = changes.changed[0]
    assert worn.days_before == 6 and worn.days_after == 2
    assert worn.friction is not None
    assert worn.friction.relative == pytest.approx(WEAR - 1.0, abs=0.04)
    assert worn.q_value < 0.05 < changes.joints[1].q_value


def test_nothing_changed_before_the_wear(fitted: sb.Fleet) -> None:
    earlier = fitted.rows.filter(pl.col("day") < date(2026, 3, 7))
    assert find_changes(earlier, Question(window=2)).changed == ()


def test_a_change_smaller_than_matters_is_none(fitted: sb.Fleet) -> None:
    assert find_changes(fitted.rows, Question(window=2, least_change=0.5)).changed == ()


def test_the_first_new_day_can_be_said(fitted: sb.Fleet) -> None:
    changes = find_changes(fitted.rows, Question(since=date(2026, 3, 8)))
    assert {j.days_after for j in changes.joints} == {1}


def test_days_long_ago_do_not_count(fitted: sb.Fleet) -> None:
    changes = find_changes(fitted.rows, Question(window=2, history=3))
    assert {(j.days_before, j.days_after) for j in changes.joints} == {(3, 2)}


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        (pl.col("day") < date(2026, 3, 2), "no joint has days both"),
        (pl.lit(False), "no file has a date"),
    ],
)
def test_why_nothing_can_be_compared(fitted: sb.Fleet, rows: pl.Expr, sentence: str) -> None:
    changes = find_changes(fitted.rows.filter(rows), Question())
    assert changes.joints == () and sentence in str(changes.why)


def test_friction_at_a_speed_has_the_error_of_what_it_is_made_of() -> None:
    m = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    order = [m.names.index(n) for n in ("coulomb_friction", "viscous_friction")]
    covariance = np.array([[0.04, -0.01], [-0.01, 0.09]])[np.ix_(order, order)]
    torque, spread = DayModel(m, covariance).friction_at(np.array([2.0, -1.0]), {})
    assert torque == pytest.approx([3.0, -2.5])
    # d/dFc = sgn v, d/dFv = v.
    assert np.diag(spread) == pytest.approx([0.04 - 4 * 0.01 + 4 * 0.09, 0.04 - 2 * 0.01 + 0.09])
    assert spread[0, 1] == pytest.approx(-0.04 + (1 + 2) * 0.01 - 2 * 0.09)


def test_speeds_and_conditions_are_those_that_days_have_in_common() -> None:
    m = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)

    def seen(low: float, high: float, warm: float) -> sb.Model:
        box = {"velocity": (low, high), "temperature": (20.0, warm), "load_torque": (-9.0, 5.0)}
        return sb.Model(m.law, values=m.values, box=box)

    # The third day hardly moved: it is no measure of what the others have in common.
    days = [seen(-1.0, 2.0, 30.0), seen(-0.8, 1.6, 34.0), seen(-0.1, 0.1, 22.0)]
    assert common_speeds(days) == pytest.approx([0.16, 0.4, 0.8, 1.6, -0.08, -0.2, -0.4, -0.8])
    assert common_conditions(days) == {"temperature": 25.0, "load_torque": 0.0}


BOX = {
    "velocity": (-2.0, 2.0),
    "position": (-1.0, 1.0),
    "acceleration": (-3.0, 5.0),
    "temperature": (25.0, 40.0),
    "load_torque": (-9.0, 9.0),
    "motor_torque": (-15.0, 15.0),
    "external_torque": (-9.0, 9.0),
}
JOINT = GeneratedJoint("revolute", 1.0, 2.0, 3.0, 1.0, 0.3, 6.0)


@pytest.mark.parametrize("spec", [*law_ids(), *(f"coulomb+stribeck+{e}" for e in effect_ids()[1:])])
def test_the_friction_of_every_model_can_be_compared(spec: str) -> None:
    m = sb.model(spec)
    values = plausible_values(m, JOINT, np.random.default_rng(0))
    m = replace(m.with_values([values[name] for name in m.names]), box=BOX)
    speeds = common_speeds([m])
    covariance = np.diag((0.01 * m.values) ** 2)
    torque, spread = DayModel(m, covariance).friction_at(speeds, common_conditions([m]))
    assert np.all(torque * speeds > 0.0)
    assert np.all(np.diag(spread) > 0.0) and np.all(np.sqrt(np.diag(spread)) < abs(torque))


def found_rows(
    found: dict[tuple[str, str], list[list[tuple[str, float, list[str]]]]],
) -> pl.DataFrame:
    """Rows of a data set: by robot and joint, for each day the effects found."""
    rows = [
        {
            **dict.fromkeys(SCHEMA),
            "robot": robot,
            "joint": joint,
            "status": DONE,
            "found": [
                {"effect": effect, "confidence": confidence, "tied": tied}
                for effect, confidence, tied in day
            ],
        }
        for (robot, joint), days in found.items()
        for day in days
    ]
    return pl.DataFrame(rows, schema=SCHEMA)


def test_what_few_joints_have_comes_first() -> None:
    load, ripple = ("load", 0.99, []), ("ripple", 0.97, [])
    found = {(f"r{k}", "a"): [[load], [load]] for k in range(6)}
    found["r1", "a"] = [[load, ripple], [ripple, load], [load]]
    found["r2", "a"] = [[ripple], [load], [load]]
    effects = find_effects(found_rows(found))
    (odd,) = effects.odd
    assert (odd.robot, odd.effect, odd.days_found, odd.days) == ("r1", "ripple", 2, 3)
    assert (odd.peers, odd.peers_with) == (5, 0)
    assert effects.joints[0] == odd
    assert [(s.effect, s.having, s.joints) for s in effects.shares] == [
        ("load", 6, 6),
        ("ripple", 1, 6),
    ]


def test_a_tie_counts_as_what_it_may_be() -> None:
    tied = ("load", 0.99, ["position"])
    found = {(f"r{k}", "a"): [[tied]] for k in range(6)}
    found["r1", "a"] = [[("position", 0.99, [])]]
    assert find_effects(found_rows(found)).odd == ()


def test_figure_of_effects_frames_what_stands_out() -> None:
    found = {(f"r{k}", "a"): [[("load", 0.99, [])] if k == 2 else []] for k in range(6)}
    effects = find_effects(found_rows(found))
    (source,) = {shown.data_source for shown in fleet_effects(effects).renderers}
    assert [robot for robot in source.data["odd"] if robot != "none"] == ["r2"]
    assert [width > 0 for width in source.data["frame"]] == [True]
    assert source.data["said"] == ["1 of 6"]


def test_json_text_picture_and_page(fitted: sb.Fleet) -> None:
    from stribeck.report.pages.fleet import fleet_page

    said = fitted.to_dict()
    assert json.loads(json.dumps(said)) == said
    assert (said["robots"], said["joints"], said["days"], said["done"]) == (3, 6, 8, 48)
    text, page = repr(fitted), fleet_page(fitted)
    assert said["notes"] and all(
        f"Note: {note}" in " ".join(text.split()) for note in said["notes"]
    )
    assert "1 joint of 6 changed" in text and "r2 elbow" in text
    assert all(len(line) <= 98 for line in text.splitlines())
    assert "r2 elbow" in page
    assert not re.search(r"<(script|img|link|iframe)[^>]*(src|href)=[\"']?(http|//)", page)
    changes = fleet_changes(fitted.changes)
    named = changes.yaxis[0].major_label_overrides
    assert len(named) == 6 and named[5] == "r2 elbow"
    assert "[%]" in changes.xaxis[0].axis_label
    axes = fitted.plot().axes
    assert [t.get_text() for t in axes[0].texts] == ["r2 elbow"]

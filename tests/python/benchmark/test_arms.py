"""Simulated arms of `stribeck benchmark robot`: what is hidden in them, and how answers count."""

from __future__ import annotations

import json

import numpy as np
import pytest
from click.testing import CliRunner
from stribeck.base.errors import StribeckError
from stribeck.benchmark.arms.answer import ArmAnswer, ArmClaim, arm_answer
from stribeck.benchmark.arms.arm import draw_arm
from stribeck.benchmark.arms.cases import EFFECTS, RIGID, ArmCase, arm_cases
from stribeck.benchmark.arms.record import arm_sample
from stribeck.benchmark.arms.score import arm_score
from stribeck.cli.main import cli
from stribeck.robot.consistent import pseudo_inertia


def test_every_joint_has_every_effect_and_a_share_is_part_of_all() -> None:
    every = arm_cases(10)
    for effect in EFFECTS:
        assert {c.joint for c in every if c.hidden == effect} == set(range(1, 7))
    names = [c.name for c in every]
    assert len(set(names)) == len(names)
    assert len({c.seed for c in every}) == len(every)
    few, more = (arm_cases(10, share=share) for share in (0.1, 0.3))
    assert set(few) < set(more) < set(every)
    assert {c.hidden for c in few} == {*EFFECTS, *RIGID, ""}
    with pytest.raises(StribeckError, match="did you mean 'cable'"):
        arm_cases(1, only="cabel")


def test_links_are_bodies() -> None:
    for seed in range(5):
        for joint in draw_arm(np.random.default_rng(seed)).joints:
            assert joint.inertial is not None
            assert np.linalg.eigvalsh(pseudo_inertia(joint.inertial)).min() > 0.0


@pytest.mark.parametrize("hidden", ["load", "payload"])
def test_what_is_hidden_has_its_size(hidden: str) -> None:
    group = "effect" if hidden == "load" else "rigid"
    made = arm_sample(ArmCase(group, hidden, 3 if hidden == "load" else 0, 7))
    assert made.size == pytest.approx(5.0, rel=0.01)
    plain = arm_sample(ArmCase("none", "", 0, 7))
    for number, (with_it, without) in enumerate(zip(made.frames, plain.frames, strict=True)):
        assert np.array_equal(with_it["position_6"], without["position_6"])
        same = [np.array_equal(with_it[f"torque_{k}"], without[f"torque_{k}"]) for k in range(1, 7)]
        if hidden == "load":
            assert same == [True, True, False, True, True, True]
        else:
            # The payload is carried in the last run.
            assert all(same) == (number == 0)


def test_how_answers_count() -> None:
    case = ArmCase("effect", "load", 2, 0)
    load = ArmClaim("2", "quadrant", ("load",), 0.5)
    other = ArmClaim("3", "delay", (), 0.1)
    right = ArmAnswer(case, claims=(load,))
    assert right.right and right.joints_without == (5, 5)
    too_many = ArmAnswer(case, claims=(load, other))
    assert too_many.right and too_many.joints_without == (4, 5)
    assert not ArmAnswer(case, claims=(other, load)).right
    assert not ArmAnswer(case, claims=(load,), rigid=(("tilt", "1"),)).right
    assert not ArmAnswer(case, failure="FitError").right
    cable = ArmCase("rigid", "cable", 4, 0)
    assert ArmAnswer(cable, rigid=(("spring", "4"),)).right
    assert not ArmAnswer(cable, rigid=(("spring", "3"),)).right
    absorbed = ArmCase("rigid", "link_centre", 4, 0)
    assert ArmAnswer(absorbed).right and not ArmAnswer(absorbed, rigid=(("tilt", "1"),)).right
    score = arm_score([right, too_many, ArmAnswer(cable)])
    shares = [(line.share.count, line.share.total) for line in score.lines]
    assert shares == [(2, 2), (0, 1), (15, 16)]
    assert [answer.case for answer in score.wrong] == [case, cable]


def test_intervals_of_a_light_arm() -> None:
    found = arm_answer(arm_cases(1, only="coverage")[0])
    assert not found.failure
    assert found.intervals is not None
    assert found.intervals.possible
    (held, every) = found.intervals.base
    assert held > 0.6 * every


def test_the_command_counts() -> None:
    words = ["benchmark", "robot", "--only", "coverage", "--share", "0.02", "--workers", "1"]
    said = json.loads(CliRunner().invoke(cli, [*words, "--json"]).stdout)
    assert said["arms"] == 1
    assert said["lines"][0]["counted"] == "95 % intervals that hold the truth"
    text = CliRunner().invoke(cli, words).stdout
    assert "every link a possible body" in text


@pytest.mark.slow
def test_a_hidden_load_is_found_on_its_joint() -> None:
    found = arm_answer(next(c for c in arm_cases(10, only="load") if c.joint == 3))
    assert found.right, found
    assert found.joints_without == (5, 5)

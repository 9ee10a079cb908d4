"""What each verb makes of a project, and what it leaves alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import ProjectError, SpecError


def test_a_verb_leaves_the_project_before_it_alone(
    begun: sb.Project, diagnosed: sb.Project, branched: sb.Project
) -> None:
    assert len(begun.tree) == 1 and begun.node.diagnosis is None
    assert len(diagnosed.tree) == 1 and diagnosed.node.diagnosis is not None
    assert [n.parent for n in branched.tree] == [None, 0, 0]
    assert [n.effect for n in branched.tree] == [None, "offset", "load"]


def test_findings_are_remembered_with_their_confidence(diagnosed: sb.Project) -> None:
    said = diagnosed.node.diagnosis
    assert said is not None and said.verdict == "missing"
    assert said.findings[0].effect == "load" and said.findings[0].confidence > 0.9
    assert diagnosed.diagnosis is said.full


def test_an_added_effect_keeps_what_the_diagnosis_said(branched: sb.Project) -> None:
    found = branched.node.found
    assert found is not None and found.confidence is not None and found.confidence > 0.9
    assert "N m higher under" in found.where
    guess = branched.tree.find("guess")
    assert guess.found is not None and guess.found.confidence is None
    base, load = branched.tree.root.kept, branched.node.kept
    assert load.rmse_held_out < 0.5 * base.rmse_held_out
    assert load.rmse_held_out == pytest.approx(0.05, rel=0.1)


def test_what_was_added_before_is_gone_to_and_not_made_again(branched: sb.Project) -> None:
    again = branched.back(0).add("offset")
    assert again.current == 1 and len(again.tree) == 3


def test_back_goes_to_the_parent_a_number_or_a_name(branched: sb.Project) -> None:
    assert branched.back().current == 0
    assert branched.back(1).current == branched.back("guess").current == 1
    with pytest.raises(ProjectError, match="has no parent"):
        branched.back(0).back()
    with pytest.raises(ProjectError, match="did you mean 'guess'"):
        branched.back("gues")


def test_names_are_words_and_nobody_elses(branched: sb.Project) -> None:
    with pytest.raises(ProjectError, match="has the name 'guess' already"):
        branched.named("guess")
    with pytest.raises(ProjectError, match="is a number"):
        branched.named("7")
    assert branched.back(1).named("").tree.node(1).name == ""


def test_a_rejected_effect_is_not_tried_here_and_below(diagnosed: sb.Project) -> None:
    rejecting = diagnosed.reject("load", "the payload is known")
    again = rejecting.diagnose().node.diagnosis
    assert again is not None and again.finding("load") is None
    assert rejecting.add("offset", starts=1).tree.rejected(1) == {"load": "the payload is known"}
    taken_back = rejecting.accept("load")
    assert taken_back.tree.rejected(0) == {}
    with pytest.raises(ProjectError, match="not rejected"):
        taken_back.accept("load")


def test_an_effect_that_is_added_is_no_longer_rejected(begun: sb.Project) -> None:
    """The later verdict replaces the earlier one, for a new node and for one that exists."""
    rejecting = begun.reject("load", "the payload is known").reject("offset")
    made = rejecting.add("load", starts=1)
    assert made.tree.rejected(made.current) == {"offset": ""}
    assert "the payload is known" not in repr(made)
    again = made.back().reject("load").add("load")
    assert again.current == made.current and "load" not in again.tree.rejected(made.current)


def test_dropping_an_effect_gives_back_the_error_without_it(branched: sb.Project) -> None:
    both = branched.add("offset", starts=2)
    without = both.drop("load", starts=2)
    assert without.node.kept.model.spec == "coulomb+offset"
    offset = branched.tree.find("guess").kept
    assert without.node.kept.rmse == pytest.approx(offset.rmse, rel=1e-6)
    with pytest.raises(SpecError, match="not in coulomb"):
        branched.drop("gravity")


def test_what_a_law_has_by_itself_cannot_be_dropped(folder: Path) -> None:
    data = folder / "data" / "joint.csv"
    made = sb.Project.new(folder / "b.toml", data, "bittencourt_a", starts=1, joint_kind="revolute")
    with pytest.raises(SpecError, match="stribeck is part of the law"):
        made.drop("stribeck")


@pytest.mark.slow
def test_improve_makes_a_node_of_each_step_and_says_so(begun: sb.Project) -> None:
    seen: list[int] = []
    made = begun.improve(each=lambda project: seen.append(len(project.tree)))
    whole = sb.improve("coulomb", begun.recording)
    steps = [s.finding.effect for s in whole.steps]
    assert [n.effect for n in made.tree.path(made.current)][1:] == steps == ["load"]
    assert np.array_equal(made.node.kept.model.values, whole.final.model.values)
    assert made.node.diagnosis is not None and made.node.diagnosis.verdict == "none"
    assert seen[-1] == len(made.tree) == 2
    assert made.back(0).improve().tree.node(1).effect == "load"
    assert len(made.back(0).improve().tree) == 2


def test_improve_heeds_what_is_rejected(diagnosed: sb.Project) -> None:
    made = diagnosed.reject("load").improve(most_steps=1)
    assert "load" not in [node.effect for node in made.tree]


def test_a_way_that_drops_an_effect_keeps_it_as_a_branch(begun: sb.Project) -> None:
    """The loop finds an effect superfluous: its branch stays, the way goes on beside it."""
    from stribeck.diagnosis.diagnose import diagnose
    from stribeck.diagnosis.loop.path import Dropped, ImprovementPath, ImprovementStep

    said = diagnose(begun.fit, brief=True)
    first = said.findings[0]
    later = sb.add(first.fit, "offset", starts=1)
    alone = sb.add(begun.fit, "offset", starts=1)
    other = replace(first, effect="offset")
    step = ImprovementStep(first, begun.fit, first.fit)
    grown = ImprovementPath(begun.fit, said, (step, ImprovementStep(other, first.fit, later)))
    pruned = ImprovementPath(
        begun.fit,
        said,
        (ImprovementStep(other, begun.fit, alone),),
        (Dropped("load", begun.fit, "superfluous once offset is in the model"),),
    )
    made = begun._along(0, grown)._along(0, pruned)
    assert len(made.tree) == 4 and made.node.kept.holds(alone) and made.node.parent == 0
    assert made.tree.rejected(0) == {"load": "superfluous once offset is in the model"}


def test_two_nodes_side_by_side(branched: sb.Project) -> None:
    sides = branched.compare("guess", 2)
    answer = sides.to_dict()
    assert answer["nodes"] == [1, 2] and answer["better"] == 2
    assert answer["standard_errors_between"] > 2.0
    assert [row["model"] for row in answer["models"]] == ["coulomb+offset", "coulomb+load"]
    assert "The difference is significant" in " ".join(repr(sides).split())
    same = branched.compare(2, 2)
    assert same.difference.statistic == 0.0 and "not significantly different" in repr(same)


def test_a_formula_under_a_name_of_before_is_refused(begun: sb.Project) -> None:
    once = begun.add("creep = c*abs(load)*sgn(v)", starts=1)
    assert once.node.effect == "creep"
    assert once.back().add("creep = c*abs(load)*sgn(v)").current == once.current
    with pytest.raises(SpecError, match="another name"):
        once.back().add("creep = c*v^3")


def test_tables_and_text_hold_the_tree(branched: sb.Project) -> None:
    frame = branched.to_frame()
    assert frame["node"].to_list() == [0, 1, 2] and frame["parent"].to_list() == [None, 0, 0]
    assert frame.filter("current")["model"].to_list() == ["coulomb+load"]
    text = repr(branched)
    assert "├ + offset" in text and "▸ 2  └ + load" in text and "'guess'" in text
    assert 'inertia, at node 2 and below it: known "from CAD"' in text
    assert all(len(line) <= 100 for line in text.splitlines())
    assert "&#34;from CAD" in branched._repr_html_()


def test_what_is_drawn_is_the_base_and_the_current_model(branched: sb.Project) -> None:
    labels = [text.get_text() for text in branched.plot().legends[0].get_texts()]
    assert labels[0].startswith("coulomb  (") and labels[1].startswith("coulomb+load  (")
    alone = branched.back(0).plot().legends[0].get_texts()
    assert len(alone) == len(labels) - 1
    sides = branched.compare(0, 2)
    assert sides.to_frame().height > 2 and "<pre>Node 0" in sides._repr_html_()

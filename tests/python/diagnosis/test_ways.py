"""The loop begins with other effects too where the first one is in doubt."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.benchmark.cases import cases
from stribeck.diagnosis.diagnose import diagnose
from stribeck.diagnosis.loop.path import ImprovementPath
from stribeck.diagnosis.loop.ways import FIRM, best_of, other_beginnings, predicts_better
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.trials.evidence import difference
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.trial import TIE
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def start(tmp_path_factory: pytest.TempPathFactory) -> ImprovementPath:
    """A joint with a wrong inertia and a Stribeck curve."""
    _, _, v, a = motion()
    extra = 0.2 * a + 1.5 * np.exp(-((v / 0.15) ** 2)) * np.sign(v)
    folder = tmp_path_factory.mktemp("ways")
    fitted = sb.fit("coulomb", record(folder, joint(extra)), starts=1)
    return ImprovementPath(fitted, diagnose(fitted, brief=True))


def way(start: ImprovementPath, *effects: str) -> ImprovementPath:
    """The path that has added some effects."""
    for effect in effects:
        after = sb.add(start.current, effect, starts=2)
        said = start.last.findings[0]
        finding = replace(
            said, effect=effect, before=start.current, fit=after, weight=0.5, certainty=1.0
        )
        start = start.with_finding(replace(finding, indistinguishable_from=()))
    return start


def begins(start: ImprovementPath, path: ImprovementPath) -> list[str]:
    """What the loop begins with instead, after it has taken `path`."""
    return [finding.effect for finding in other_beginnings(start.last, path, 0)]


def test_other_beginnings_are_tried_where_the_first_is_in_doubt(start: ImprovementPath) -> None:
    first = start.last.findings[0]
    weights = {"load": 0.2, "gain": 0.4, "position": 0.3}
    others = [replace(first, effect=effect, weight=w) for effect, w in weights.items()]

    def doubted(weight: float) -> ImprovementPath:
        findings = (replace(first, weight=weight), *others)
        return replace(start, last=replace(start.last, findings=findings))

    assert begins(doubted(0.5), start) == ["gain", "position"]
    assert begins(doubted(FIRM), start) == []


def test_what_may_not_be_claimed_alone_begins_where_structure_remains(
    start: ImprovementPath,
) -> None:
    """Of an effect that contains a simpler one, that; two at most."""
    said = replace(
        start.last,
        findings=(),
        passed=("frictional_lag", "inertia", "spring"),
        unexplained=Unexplained(0.5, None),
    )
    ended = replace(start, last=said)
    assert begins(ended, ended) == ["stribeck", "inertia"]
    assert all(found.weight == 0.0 for found in other_beginnings(said, ended, 0))
    explained = replace(said, unexplained=Unexplained(0.0, None))
    assert begins(ended, replace(start, last=explained)) == []
    # A first effect that is firm is not in doubt, whatever remains.
    assert begins(ended, replace(way(start, "inertia"), last=said)) == ["stribeck", "inertia"]
    firm = way(start, "inertia")
    sure = replace(firm.steps[0].finding, weight=1.0)
    assert begins(ended, replace(firm.with_instead(sure), last=said)) == []


def test_the_way_that_predicts_better_is_taken(start: ImprovementPath) -> None:
    greedy, right = way(start, "spring"), way(start, "stribeck", "inertia")
    best = best_of([greedy, right], 0.01, 0)
    assert [step.finding.effect for step in best.steps] == ["stribeck", "inertia"]
    assert best.steps[0].finding.weight == NARROW
    assert [gone.effect for gone in best.dropped] == ["spring"]
    assert "stribeck" in best.dropped[0].reason
    # Its beginning must pass all tests at the end.
    assert best_of([greedy, right], 2.0, 0) is greedy
    # The other way round nothing changes.
    assert best_of([right, greedy], 0.01, 0) is right


@pytest.mark.parametrize(("worse_blocks", "better"), [(0, True), (1, True), (3, False)])
def test_a_stretch_with_most_of_the_error_does_not_hide_what_predicts_better(
    start: ImprovementPath, worse_blocks: int, better: bool
) -> None:
    """It makes the standard error of the difference as large as the difference."""
    fitted, recording = start.start, start.start.recording
    noise = np.random.default_rng(1).standard_normal(recording.time.size)
    noise[recording.time < 0.01 * recording.time[-1]] *= 30.0
    blocks = np.unique(recording.block)
    factor = np.where(np.isin(recording.block, blocks[::-1][:worse_blocks]), 1.03, 0.97)
    other = replace(fitted, held_out=recording.torque - noise)
    model = replace(fitted, held_out=recording.torque - factor * noise)
    assert difference(other, model).statistic < TIE
    assert predicts_better(model, other) == better
    assert not predicts_better(other, model)


def test_of_ways_that_predict_alike_the_one_with_fewer_parameters_is_taken(
    start: ImprovementPath,
) -> None:
    wide, small = way(start, "inertia", "frictional_lag"), way(start, "inertia", "stribeck")
    assert best_of([wide, small], 0.01, 0).current is small.current
    assert best_of([small, wide], 0.01, 0) is small
    # What it began with is in the model still, and nothing was dropped.
    assert best_of([wide, small], 0.01, 0).dropped == ()


def test_a_proxy_does_not_stay_where_the_loop_began_with_it(tmp_path: Path) -> None:
    """Torque along the sign of the acceleration is no error of inertia, though it is alike."""
    a = motion()[3]
    found = sb.improve("coulomb", record(tmp_path, joint(0.4 * np.sign(a))))
    assert found.steps == () and found.last.verdict == "unexplained"


@pytest.mark.slow
def test_an_effect_that_explains_nearly_as_much_begins_too(tmp_path: Path) -> None:
    """Friction under load behind a load on a wrong scale: saturation alone stands in for both."""
    name = "closed_loop-load-0.3x-load_scale-465145000"
    case = next(c for c in cases(1, seed=465, realism=1) if c.name == name)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    found = sb.improve("coulomb", sb.read(tmp_path / "recording.parquet"))
    assert {step.finding.effect for step in found.steps} == {"gain", "load"}
    assert found.last.verdict == "none"

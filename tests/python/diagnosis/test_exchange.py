"""One effect exchanged for another: whole models are compared, not the steps to them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.benchmark.cases import Case
from stribeck.diagnosis.diagnose import diagnose
from stribeck.diagnosis.loop import exchange
from stribeck.diagnosis.loop.exchange import tied
from stribeck.diagnosis.loop.path import ImprovementPath, ImprovementStep
from stribeck.diagnosis.testable import Untestable
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.sifting import Sifted
from stribeck.diagnosis.trials.trial import Trial
from synthetic import Array, joint, motion, record


def detour(folder: Path, extra: Array, *effects: str, rivals: tuple[str, ...]) -> ImprovementPath:
    """A path that took `effects`, on a recording that holds `extra` torque."""
    current = start = sb.fit("coulomb", record(folder, joint(extra)), starts=1)
    said = diagnose(start, brief=True)
    steps: list[ImprovementStep] = []
    for effect in effects:
        after = sb.add(current, effect, starts=2)
        finding = replace(
            said.findings[0],
            effect=effect,
            before=current,
            fit=after,
            weight=1.0,
            certainty=1.0,
            indistinguishable_from=(),
        )
        steps.append(ImprovementStep(finding, current, after, rivals))
        current = after
    return ImprovementPath(start, said, tuple(steps))


def test_inertia_takes_the_place_of_effects_that_imitate_it(tmp_path: Path) -> None:
    """A wrong inertia, of which a spring and a position dependence explain most."""
    path = detour(tmp_path, 0.2 * motion()[3], "spring", "position", rivals=("inertia", "offset"))
    assert path.current.rmse_held_out is not None
    found = path.exchanges((), 0.01, seed=0)
    assert found.best is not None and found.best.by.effect == "inertia"
    better = path.exchanged(found.best, seed=0)
    assert "inertia" in better.current.model.effects
    assert better.current.rmse_held_out == pytest.approx(0.03, rel=0.05)
    assert found.best.finding.effect in {gone.effect for gone in better.dropped}
    assert better.steps[-1].after is better.current
    inertia = next(step for step in better.steps if step.finding.effect == "inertia")
    assert inertia.finding.confidence == 1.0 and not inertia.finding.indistinguishable_from
    assert path.exchanges(("inertia",), 0.01, seed=0).best is None
    hidden = Untestable("inertia", "there is no acceleration", "record accelerated motion")
    blind = replace(path, last=replace(path.last, untestable=(hidden,)))
    assert blind.exchanges((), 0.01, seed=0).best is None


def test_what_takes_a_place_is_no_surer_than_if_it_had_been_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def by_little(before: sb.Fit, trial: Trial, *_: object) -> Sifted:
        return Sifted(stand=(trial,)).narrowed(trial, NARROW)

    path = detour(tmp_path, 0.2 * motion()[3], "spring", rivals=("inertia",))
    monkeypatch.setattr(exchange, "standing", by_little)
    found = path.exchanges((), 0.01, seed=0)
    assert found.best is not None and found.best.most == NARROW
    (step,) = path.exchanged(found.best, seed=0).steps
    assert step.finding.effect == "inertia" and step.finding.confidence == NARROW


def test_a_wider_effect_in_place_of_the_simpler_one_is_not_certain(tmp_path: Path) -> None:
    """Most of its evidence is that of the simpler one."""
    v, tl = motion()[2], joint()["load_torque"].to_numpy()
    extra = 0.1 * np.abs(tl) * np.sign(v) * (1.0 + np.where(v * tl > 0, 1.5 * np.abs(v), 0.0))
    path = detour(tmp_path, extra, "load", rivals=("quadrant",))
    best = path.exchanges((), 0.01, seed=0).best
    assert best is not None and best.by.effect == "quadrant" and best.most == NARROW


def quadrant_torque() -> Array:
    """Friction under load that differs between motoring and generating, and grows with speed."""
    v, tl = motion()[2], joint()["load_torque"].to_numpy()
    return 0.1 * np.abs(tl) * np.sign(v) + np.where(v * tl > 0, 0.15 * np.abs(v), 0.05) * tl


def test_a_wider_form_of_another_effect_is_a_rival(tmp_path: Path) -> None:
    """A gain and a load dependence are nearly a load dependence that differs by quadrant."""
    path = detour(tmp_path, quadrant_torque(), "gain", "load", rivals=())
    best = path.exchanges((), 0.01, seed=0).best
    assert best is not None and (best.finding.effect, best.by.effect) == ("gain", "quadrant")


def test_what_measuring_explains_as_well_is_a_tie(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It takes no place, but predicts better, so that the effect is not certain either."""
    path = detour(tmp_path, quadrant_torque(), "gain", "load", rivals=())
    monkeypatch.setattr(exchange, "standing", lambda *_: Sifted())
    found = path.exchanges((), 0.01, seed=0)
    assert found.best is None and found.ties["gain"]["quadrant"] == 1.0


def test_a_true_effect_is_not_exchanged(tmp_path: Path) -> None:
    """A Stribeck curve with an offset; neither viscous friction nor gravity replaces them."""
    v = motion()[2]
    extra = 1.5 * np.exp(-np.abs(v) / 0.15) * np.sign(v) + 0.5
    path = detour(
        tmp_path, extra, "stribeck", "offset", rivals=("nonlinear_viscous", "gravity", "direction")
    )
    found = path.exchanges((), 0.01, seed=0)
    assert found.best is None and not found.ties


def test_confidence_is_shared_with_what_predicts_as_well(tmp_path: Path) -> None:
    path = detour(tmp_path, np.full(3000, 0.5), "offset", rivals=())
    (step,) = path.with_ties({"offset": {"gravity": 1.0, "spring": 0.5}}).steps
    assert step.finding.confidence == pytest.approx(0.4)
    assert step.finding.indistinguishable_from == ("gravity", "spring")
    # Said once, a tie counts once.
    assert tied(step.finding, {"gravity": 1.0}) == (step.finding.confidence, ("gravity", "spring"))


@pytest.mark.slow
def test_a_lag_of_friction_gives_way_to_an_inertia(tmp_path: Path) -> None:
    """With the inertia the lag would be shorter than a sample: the curve alone remains."""
    hidden, late = ("inertia", "stribeck"), ("amplifier_warm_up",)
    case = Case("two", "closed_loop", hidden, 463168000, 2.0, nuisances=late)
    case.make().frame.write_parquet(tmp_path / "recording.parquet")
    improved = sb.improve("coulomb", sb.read(tmp_path / "recording.parquet"))
    named = [step.finding.effect for step in improved.steps]
    assert named == ["stribeck", "inertia", "warm_up"]

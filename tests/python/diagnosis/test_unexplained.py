"""How much of the error is structure, and where it is called largest, by definition."""

from __future__ import annotations

import numpy as np
import pytest
from made_fits import Array, Moved, left
from stribeck.diagnosis.residual import unexplained as module
from stribeck.diagnosis.residual.explainable import Explainable
from stribeck.diagnosis.residual.noise_floor import REACHED, NoiseFloor
from stribeck.diagnosis.residual.shocks import Shocks
from stribeck.diagnosis.residual.unexplained import (
    FEWEST_ROWS,
    STRUCTURE,
    SUSPICIOUS,
    WORSE,
    Unexplained,
    unexplained,
)
from stribeck.diagnosis.residual.varying_friction import VaryingFriction

#: Speeds that sweep to and fro; the torque has no sign, so that no regime of power has samples.
SPEED = 3.0 * np.sin(0.1 * np.arange(1000) + 0.05)
#: Without reversals, which are slow as well.
AHEAD = SPEED + 4.0
FLAT = np.where(np.arange(SPEED.size) % 2, 2.0, -2.0)
NO_FLOOR = NoiseFloor(None)


def could(share: float) -> Explainable:
    """A regressor that removes this share of the squared error."""
    return Explainable(0.0, 0.0, share)


@pytest.fixture(autouse=True)
def asked(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """No friction varies, and nothing lasts; what the search for it was told is kept."""
    kept: list[bool] = []

    def constant(fit: object, *, suspected: bool = False) -> VaryingFriction:
        kept.append(suspected)
        return VaryingFriction(0.0)

    monkeypatch.setattr(module, "varying_friction", constant)
    monkeypatch.setattr(module, "lasting_square", lambda fit: 0.0)
    monkeypatch.setattr(module, "shocks", lambda fit: Shocks())
    return kept


def varies(monkeypatch: pytest.MonkeyPatch, rms: float) -> None:
    monkeypatch.setattr(module, "varying_friction", lambda fit, **_: VaryingFriction(rms))


def test_nothing_is_said_without_a_regressor_or_an_error() -> None:
    assert unexplained(left(Moved(SPEED), FLAT), NO_FLOOR, None) == Unexplained(None, None)
    perfect = left(Moved(SPEED), np.zeros(SPEED.size))
    assert unexplained(perfect, NO_FLOOR, could(0.5)) == Unexplained(None, None)
    assert not Unexplained(None, None).is_structure


@pytest.mark.parametrize(
    ("found", "floor", "share"),
    [
        (0.5 * STRUCTURE, None, 0.5 * STRUCTURE),
        (STRUCTURE, 0.0, STRUCTURE),  # an extrapolation that ends at zero says nothing
        (2.0 * STRUCTURE, None, 2.0 * STRUCTURE),
        (2.0 * STRUCTURE, 1.0, 0.75),  # the floor is half of the error
        (0.9, 1.0, 0.9),
    ],
)
def test_the_share_is_what_lies_above_the_floor(
    found: float, floor: float | None, share: float
) -> None:
    said = unexplained(left(Moved(SPEED), FLAT), NoiseFloor(floor), could(found))
    assert said.share == pytest.approx(share)
    assert said.is_structure == (found > STRUCTURE)
    assert said.where == ("everywhere" if found > STRUCTURE else None)
    assert said.to_dict() == {"share": said.share, "where": said.where}


def test_an_error_far_above_what_repeats_differ_by_is_structure() -> None:
    """Although no regressor finds it: vibration that a periodic motion excites, for example."""
    fit = left(Moved(SPEED), FLAT)
    for floor, structure in ((0.9, True), (2.0 / REACHED, False)):
        said = unexplained(fit, NoiseFloor(floor), could(0.5 * STRUCTURE))
        assert said.is_structure == structure
    said = unexplained(fit, NoiseFloor(0.5), could(0.5 * STRUCTURE))
    assert said.shown == 0.0
    assert said.share == pytest.approx(1.0 - 0.5**2 / 2.0**2)
    assert (
        said.where is not None
        and "repeats of the same state typically differ by only 0.5 N m" in said.where
    )


def test_the_error_is_that_of_samples_it_was_not_fitted_to() -> None:
    fit = left(Moved(SPEED), 0.01 * FLAT, held_out_residual=FLAT)
    assert unexplained(fit, NoiseFloor(1.0), could(0.2)).share == pytest.approx(0.75)


def test_varying_friction_is_named_where_it_is_the_larger_part(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fit = left(Moved(SPEED), FLAT)
    varies(monkeypatch, 1.2)  # 0.36 of the squared error
    said = unexplained(fit, NO_FLOOR, could(0.3))
    assert said.share == pytest.approx(0.36)
    assert said.where is not None and said.where.startswith("friction varies by 1.2 N m (RMS)")
    said = unexplained(fit, NO_FLOOR, could(0.4))
    assert said.share == pytest.approx(0.4) and said.where == "everywhere"
    # What lies above the floor belongs to it, but shows in no channel.
    above = unexplained(fit, NoiseFloor(1.0), could(0.4))
    assert (above.share, above.shown) == (pytest.approx(0.75), pytest.approx(0.4))
    # It is a share, whatever its estimate.
    varies(monkeypatch, 5.0)
    assert unexplained(fit, NO_FLOOR, could(0.3)).share == 1.0


def test_what_lasts_is_structure_without_a_regressor_and_a_floor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fit, square = left(Moved(SPEED), FLAT), 4.0
    for share in (0.5 * STRUCTURE, 2.0 * STRUCTURE):
        monkeypatch.setattr(module, "lasting_square", lambda fit, share=share: share * square)
        said = unexplained(fit, NO_FLOOR, None)
        assert said.is_structure == (share > STRUCTURE)
    assert said.share == said.shown == pytest.approx(2.0 * STRUCTURE)
    assert said.where is not None and said.where.startswith(
        "what lasts longer than the noise of a sensor is 20 %"
    )
    # A regressor that finds it says where.
    assert unexplained(fit, NO_FLOOR, could(0.4)).where == "everywhere"


def test_shocks_are_structure_and_say_their_cause(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are said where they are more than what a regressor finds."""
    fit = left(Moved(SPEED), FLAT)
    monkeypatch.setattr(module, "shocks", lambda fit: Shocks(0.3, 0.08, 4.2))
    said = unexplained(fit, NO_FLOOR, could(0.2))
    assert said.share == said.shown == said.shocks == 0.3
    assert said.where is not None and said.where.startswith("in the 80 ms after the load torque")
    assert "4.2 times that elsewhere" in said.where and "backlash" in said.where
    assert unexplained(fit, NO_FLOOR, could(0.4)).where == "everywhere"


def test_friction_is_compared_once_nothing_is_left_to_add(asked: list[bool]) -> None:
    fit = left(Moved(SPEED), FLAT)
    unexplained(fit, NO_FLOOR, could(0.3), last=False)
    assert asked == []
    total = 4.0
    for above in (0.0, 0.99 * SUSPICIOUS, 1.01 * SUSPICIOUS):
        unexplained(fit, NoiseFloor(np.sqrt(total * (1.0 - above))), could(0.3))
    unexplained(fit, NO_FLOOR, could(0.3), last=True)
    assert asked == [False, False, True, False]


@pytest.mark.parametrize(
    ("speed", "mask", "words"),
    [
        (AHEAD, AHEAD <= np.quantile(AHEAD, 0.25), "at low speed"),
        (AHEAD, AHEAD >= np.quantile(AHEAD, 0.75), "at high speed"),
        (SPEED, SPEED > 0.0, "moving forward"),
        (SPEED, SPEED < 0.0, "moving backward"),
        (AHEAD, np.arange(AHEAD.size) >= 750, "in the last quarter of the time"),
    ],
)
def test_the_worst_place_is_named_with_its_ratio(speed: Array, mask: Array, words: str) -> None:
    residual = np.where(mask, 3.0, 1.0) * FLAT
    recording = Moved(speed, time=0.5 * np.arange(speed.size))
    said = unexplained(left(recording, residual), NO_FLOOR, could(0.5))
    ratio = 6.0 / np.sqrt(np.mean(residual**2))
    assert said.where == f"the error is {ratio:.2g} times the average {words}"


@pytest.mark.parametrize("always", [True, False], ids=["in each pass", "in a few passes"])
def test_the_part_of_the_stroke_is_named_that_is_worst_in_each_pass(always: bool) -> None:
    passes = 20
    position = np.tile(np.linspace(0.0, 1.0, 400), passes)
    worst = (position > 0.5) & (position < 0.55)
    if not always:
        worst &= np.arange(position.size) >= position.size // 2
    residual = np.where(worst, 3.0, 1.0) * np.where(np.arange(position.size) % 2, 2.0, -2.0)
    recording = Moved(np.ones(position.size), position=position)
    said = unexplained(left(recording, residual), NO_FLOOR, could(0.5)).where
    assert said is not None
    assert ("between 0.5 and 0.55 m" in said) is always


def test_a_place_must_be_clearly_worse() -> None:
    """At twice the excess of `WORSE` it is named, at half of it is not."""
    for excess, named in ((0.5, False), (2.0, True)):
        ratio = 1.0 + excess * (WORSE - 1.0)
        # Half of the samples have this ratio to the average of all.
        other = np.sqrt(2.0 - ratio**2)
        residual = np.where(SPEED > 0.0, ratio, other) * FLAT
        recording = Moved(SPEED, time=0.5 * np.arange(SPEED.size))
        said = unexplained(left(recording, residual), NO_FLOOR, could(0.5)).where
        assert ("moving forward" in str(said)) == named


def test_places_with_few_samples_or_without_a_name_are_passed_over() -> None:
    few = np.arange(SPEED.size) < FEWEST_ROWS - 1
    warm = np.where(few, 10.0, np.linspace(40.0, 41.0, SPEED.size))
    residual = np.where(few, 30.0, 1.0) * FLAT
    # The quarter of the coldest holds them all: it is the first of the time as well.
    said = unexplained(left(Moved(SPEED, temperature=warm), residual), NO_FLOOR, could(0.5)).where
    assert "cold" in str(said) or "first quarter" in str(said)
    # A drive that is off is no place that is named.
    off = np.arange(SPEED.size) % 4 == 0
    loud = np.where(off, 3.0, 1.0) * FLAT
    said = unexplained(left(Moved(SPEED, enabled=~off), loud), NO_FLOOR, could(0.5)).where
    assert said == "everywhere"
    # Transients do not count.
    late = left(Moved(SPEED), np.where(SPEED > 0.0, 1.0, 9.0) * FLAT, transient=SPEED < 0.0)
    assert unexplained(late, NO_FLOOR, could(0.5)).where == "everywhere"
    short = slice(0, FEWEST_ROWS // 2)
    one = left(Moved(SPEED[short]), np.where(SPEED[short] > 1.0, 3.0, 1.0))
    assert unexplained(one, NO_FLOOR, could(0.5)).where == "everywhere"


def test_the_share_of_excluded_samples_is_kept() -> None:
    residual = np.where(np.arange(SPEED.size) < 10, 50.0, FLAT)
    fit = left(Moved(SPEED), residual)
    fit.transient[:10] = True
    scored = fit.recording.moving
    expected = (residual[:10] ** 2)[scored[:10]].sum() / (residual**2)[scored].sum()
    made = unexplained(fit, NO_FLOOR, could(0.0))
    assert made.excluded == pytest.approx(expected) and made.excluded > 0.8
    assert unexplained(left(Moved(SPEED), FLAT), NO_FLOOR, could(0.0)).excluded == 0.0

"""An example of an effect: a generated recording, and models without and with the effect."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.effect.describe import base_of
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.result import Fit
from stribeck.models.build import model
from stribeck.motion.generate.hidden import generate
from stribeck.recording.load import read
from stribeck.report.finding_view import FindingView, finding_view

__all__ = ["EffectExample", "effect_example"]

#: Seconds and rate of the recording, Hz.
SECONDS, RATE = 60.0, 100.0


@dataclass(frozen=True)
class EffectExample:
    """The true model of a recording without torque noise, and the same without an effect."""

    effect: str
    without: Fit
    with_it: Fit

    @property
    def view(self) -> FindingView:
        """The residuals of both against the channel in which the effect shows."""
        return finding_view(self.effect, self.without, self.with_it)


def effect_example(effect: str) -> EffectExample:
    """Generate a recording with an effect of plausible size.

    Parameters
    ----------
    effect : str
        An id of the catalog.

    Examples
    --------
    >>> example = effect_example("load")
    >>> example.without.rmse > 10 * example.with_it.rmse
    True
    """
    hidden = [*base_of(effect), effect]
    frame, truth = generate(hidden, seconds=SECONDS, rate=RATE, noise=0.0)
    values = {name: known["value"] for name, known in truth["parameters"].items()}
    whole = model(truth["spec"], constants=truth["constants"], **values)
    recording = read(frame)
    return EffectExample(
        effect, evaluate(whole.without_effect(effect), recording), evaluate(whole, recording)
    )

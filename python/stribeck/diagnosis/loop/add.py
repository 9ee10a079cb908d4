"""One effect added to a fitted model by hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from stribeck.base.arguments import door
from stribeck.base.errors import FitError
from stribeck.base.shown import Shown
from stribeck.diagnosis.trials.dry_friction import lacks_dry_friction, spelled_out
from stribeck.diagnosis.trials.trial import add_effect
from stribeck.fitting.fit import on_recording, with_choices
from stribeck.fitting.result import FIT, Fit
from stribeck.identify.stated.choices import ChoiceArguments, parameters_of_effects
from stribeck.models.catalog import check_effect, simpler_effect
from stribeck.models.formula_law import is_formula
from stribeck.recording.several.concat import Recordings

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True, repr=False)
class Addition(Shown):
    """One effect added: the model before and after, on the same samples.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=20.0, rate=50.0, seed=1)[0])
    >>> before = sb.fit("coulomb", recording, starts=1)
    >>> added = sb.Addition("load", before, sb.add(before, "load", starts=1))
    >>> added.after.rmse_held_out < 0.2 * added.before.rmse_held_out
    True
    """

    effect: str
    before: Fit
    after: Fit

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck add`."""
        return {
            "model": self.after.model.spec,
            "effect": self.effect,
            "rmse_before": self.before.rmse,
            "rmse_after": self.after.rmse,
            "rmse_held_out_before": self.before.rmse_held_out,
            "rmse_held_out_after": self.after.rmse_held_out,
            "unit": self.after.model.torque_unit,
            "parameters": {n: e.to_dict() for n, e in self.after.estimates.items()},
            "scored": self.after.recording.scored(self.after.scored),
        }


@door(FitError, fitted=FIT)
def add(
    fitted: Fit,
    effect: str,
    recording: Recordings | None = None,
    *,
    starts: int = 20,
    seed: int = 0,
    **choices: Unpack[ChoiceArguments],
) -> Fit:
    """Add `effect` to a fitted model and refit it on `recording` (default: the fit's own).

    Parameters
    ----------
    effect : str
        An id of the catalog, or an effect by formula: ``"creep = c*abs(load)*sgn(v)"``. Where
        a law by formula has no dry friction, ``"dry"`` stands for ``"dry = c*sgn(v)"``.
    **choices
        `start`, `bounds` and `fix` of `stribeck.fit`, of parameters of the model, which is then
        fitted again, or of the effect.

    Raises
    ------
    SpecError
        The effect is unknown or in the model already.
    FitError
        The recording lacks a channel that the effect needs.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> before = sb.fit("coulomb", recording, starts=2)
    >>> after = sb.add(before, "load", starts=2)
    >>> after.model.spec, after.rmse_held_out < 0.2 * before.rmse_held_out
    ('coulomb+load', True)
    """
    if lacks_dry_friction(fitted.model):
        effect = spelled_out(effect)
    if not is_formula(effect):
        check_effect(effect)
    before = with_choices(
        on_recording(fitted, recording, seed), choices, parameters_brought_by(effect), seed
    )
    return add_effect(before, effect, starts=starts, seed=seed)


def parameters_brought_by(effect: str) -> dict[str, str]:
    """Names of the parameters of an effect, and of the simpler one it contains, by any name."""
    effect = spelled_out(effect)
    simpler = simpler_effect(effect)
    return parameters_of_effects([effect] if simpler is None else [simpler, effect])

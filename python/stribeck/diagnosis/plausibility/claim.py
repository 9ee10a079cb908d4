"""A claim to be judged: one effect, and the fits without and with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import StribeckError
from stribeck.fitting.result import Fit
from stribeck.identify.problem import Problem
from stribeck.models.model import Model
from stribeck.models.rigid_body import own_gravity, own_load

Array = NDArray[np.float64]


def first_reason(reasons: Iterable[str | None]) -> str | None:
    """The first of the reasons that there is; None where there is none."""
    return next((reason for reason in reasons if reason is not None), None)


@dataclass(frozen=True)
class Claim:
    """One effect that passed the test of evidence.

    Attributes
    ----------
    least_fall
        Least relative fall of the held-out RMSE that a finding must bring.
    """

    effect: str
    before: Fit
    after: Fit
    least_fall: float = 0.0

    @cached_property
    def torque(self) -> Array | None:
        """Torque of the effect in the fit with it, array [m]; None where it has none of its own."""
        return term_torque(self.after, self.effect)

    @cached_property
    def change(self) -> Array:
        """What the effect changes in the prediction, weighted as in the fit, array [m]."""
        return self.before.weighted((self.after.prediction - self.before.prediction)[self.rows])

    @property
    def rows(self) -> NDArray[np.intp]:
        """Samples that the fits were made to, int array [m]."""
        return self.before.rows


def term_torques(fit: Fit) -> dict[str, Array]:
    """Torque of the law, of each effect and of each identified rigid-body term, arrays [m]."""
    model = fit.model
    names = (model.law, *model.own_effects, *model.effects, *model.rigid_body)
    found = ((name, term_torque(fit, name)) for name in names)
    return {name: torque for name, torque in found if torque is not None}


def term_torque(fit: Fit, term: str) -> Array | None:
    """Torque of a law, an effect or a rigid-body term of `fit`, array [m].

    That of an effect is what the prediction loses without it, the other values kept. None where the
    model is none without it: a delayed Stribeck curve without the curve.
    """
    model, recording = fit.model, fit.recording
    if term in model.rigid_body:
        whole, gravity = own_load(model, recording), own_gravity(model, recording)
        assert whole is not None
        rest = np.zeros_like(whole) if gravity is None else gravity
        return (rest if term == "gravity" else whole - rest)[fit.rows]
    try:
        if term == model.law:
            alone = _values_kept(
                model,
                replace(
                    model,
                    own=model.own[:1] if model.by_formula else (),
                    effects=(),
                    rigid_body=(),
                    values=np.empty(0),
                ),
            )
            return _predicted(fit, alone) - recording.known_torque[fit.rows]
        return fit.prediction[fit.rows] - _predicted(fit, model.without_effect(term))
    except (StribeckError, _core.ModelError):
        return None


def _values_kept(model: Model, other: Model) -> Model:
    known = dict(zip(model.names, model.values, strict=True))
    return other.with_values([known.get(name, np.nan) for name in other.names])


def _predicted(fit: Fit, model: Model) -> Array:
    return Problem(fit.recording, model, fit.rows, fit.own_load).predict(model.values)[fit.rows]

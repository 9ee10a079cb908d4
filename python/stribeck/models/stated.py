"""What a user states about the parameters of a model, beside their bounds (`Model.limits`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["Stated"]


@dataclass(frozen=True)
class Stated:
    """Statements about parameters, by parameter name; each is in the parameter's unit.

    A name that the model lacks is that of a parameter which a later effect may bring. A statement
    is in force where the model has all its parameters.

    Attributes
    ----------
    starts
        Start values.
    priors
        Mean and standard deviation of Gaussian priors.
    constraints
        Inequalities, ``"static_friction >= a2"``, each with the names and symbols in it.
    ties
        Formulas that parameters are equal to, ``"1.2*a4"``, each with the names and symbols in it.
    loss
        How residuals count: ``"squares"``, ``"huber"`` or ``"cauchy"``.
    algorithm
        Search from each start (`stribeck.identify.search.algorithms`); None: the default.
    """

    starts: Mapping[str, float] = field(default_factory=dict)
    priors: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    constraints: tuple[tuple[str, tuple[str, ...]], ...] = ()
    ties: Mapping[str, tuple[str, tuple[str, ...]]] = field(default_factory=dict)
    loss: str = "squares"
    algorithm: str | None = None

    @property
    def changes_the_search(self) -> bool:
        """Whether a search between bounds by least squares is not enough."""
        stated = bool(self.priors or self.constraints or self.ties)
        return stated or self.loss != "squares"

"""What the Durbin-Wu-Hausman test of a fit says."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from stribeck.report.numbers import percent, plain, unit_text

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit
    from stribeck.identify.instrumental.exogeneity import Exogeneity

#: A bias of fewer standard errors hardly changes an interval.
SMALL = 0.5
ADVICE = (
    "The measured motion is correlated with the residual, by encoder noise or by an effect that "
    "the model lacks: add a missing effect first (a diagnosis shows it), then use the estimator iv."
)


def exogeneity_text(fit: Fit) -> str:
    """Whether least squares is biased, by how much, and what to do; empty if untested."""
    test = fit.exogeneity
    if test is None:
        return ""
    freedom = test.degrees_of_freedom
    p = "p < 0.0001" if test.p < 1e-4 else f"p = {test.p:.2g}"
    figures = (
        f"Durbin-Wu-Hausman test: chi-squared {plain(test.statistic)}, {freedom} "
        f"degree{'s' if freedom > 1 else ''} of freedom, {p}."
    )
    if not test.biased:
        return f"{figures} No bias of least squares by noise of the measured motion is seen."
    name, errors = _largest(fit, test)
    if errors < SMALL:
        return (
            f"{figures} Least squares is biased by noise or a missing effect, but by less than "
            f"{SMALL:g} standard errors of each parameter."
        )
    advice = f" {ADVICE}" if fit.estimator == "ls" else ""
    return f"{figures} Least squares is biased: {_bias(fit, test, name, errors)}.{advice}"


def _largest(fit: Fit, test: Exogeneity) -> tuple[str, float]:
    """The parameter whose bias is the largest in standard errors, and how many."""
    errors = {name: fit.estimates[name].stderr for name in test.bias}
    size = {name: abs(test.bias[name]) / e for name, e in errors.items() if e}
    name = max(size, key=lambda key: size[key], default=next(iter(test.bias)))
    return name, size.get(name, math.inf)


def _bias(fit: Fit, test: Exogeneity, name: str, errors: float) -> str:
    estimate, bias = fit.estimates[name], test.bias[name]
    side = "large" if bias > 0 else "small"
    true = estimate.value - (bias if fit.estimator == "ls" else 0.0)
    share = f"{percent(abs(bias / true))}, " if true and math.isfinite(bias / true) else ""
    return (
        f"its {name} is about {plain(abs(bias))} {unit_text(estimate.unit)} too {side} "
        f"({share}{plain(errors)} standard errors)"
    )

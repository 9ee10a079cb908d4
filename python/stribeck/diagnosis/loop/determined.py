"""Which parameters of a model its recording determines, and which combinations of the others."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stribeck.fitting.result import Fit
from stribeck.identify.errors.confounded import Combination
from stribeck.identify.errors.estimates import Estimate, poorly_determined

#: Least correlation of two errors from which the combination of both is looked at.
CORRELATED = 0.7
#: A combination is known if its value is at least so many standard errors.
KNOWN = 4.0


def undetermined(estimates: Mapping[str, Estimate]) -> list[str]:
    """Names of the parameters that a recording does not determine, or only poorly."""
    poor = set(poorly_determined(estimates.values()))
    return [n for n, e in estimates.items() if not e.held and (not e.identifiable or n in poor)]


def known_combinations(fit: Fit) -> tuple[Combination, ...]:
    """What is known of the parameters that are not determined, each combination once.

    A poorly determined parameter is combined with that whose error is correlated with its own most:
    ``a + c b`` with ``c = -cov(a, b) / var(b)`` has the least variance.
    """
    made = [*fit.combinations]
    if fit.covariance is None:
        return tuple(made)
    names, values = fit.covariance.names, fit.covariance.values
    correlation = fit.covariance.correlation().values - np.eye(len(names))
    poor = [name for name in undetermined(fit.estimates) if name in names]
    pairs: set[frozenset[str]] = set()
    for name in poor:
        k = names.index(name)
        j = int(np.argmax(np.abs(correlation[k])))
        pair = frozenset((name, names[j]))
        if abs(correlation[k, j]) < CORRELATED or pair in pairs:
            continue
        factor = -float(values[k, j] / values[j, j])
        one, other = fit.estimates[name], fit.estimates[names[j]]
        value = one.value + factor * other.value
        error = float(np.sqrt(max(values[k, k] * (1.0 - correlation[k, j] ** 2), 0.0)))
        if abs(value) < KNOWN * error:
            continue
        pairs.add(pair)
        linear = all(p.linear for p in fit.model.parameters if p.name in pair)
        same = one.unit == other.unit
        coefficients = {name: 1.0, names[j]: factor}
        made.append(Combination(coefficients, value, error, one.unit, same, not linear))
    return tuple(made)

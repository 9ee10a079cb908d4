"""Identified parameters with their standard errors and covariance."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.errors.confounded import Combination, partners, reason
from stribeck.identify.errors.covariance import (
    covariance_of,
    seen,
)
from stribeck.identify.errors.directions import Directions
from stribeck.identify.errors.matrix import ParameterMatrix
from stribeck.models.model import Model
from stribeck.models.parameter import Parameter

Array = NDArray[np.float64]

#: What standard errors assume about the residual.
#:
#: ``"robust"``: it may be autocorrelated and heteroscedastic, as the residual of any sampled motion
#: is: the error of a friction model is smooth in time.
#: ``"independent"``: errors are independent and of equal variance, as those of separately measured
#: points. This is the textbook's ``s^2 (J'J)^-1`` with n - p degrees of freedom; on a sampled
#: motion it is far too optimistic.
#: ``"profile"``: as robust, with intervals from the profile likelihood instead of symmetric ones.
#: ``"bootstrap"``: from refits to resampled blocks of the recording.
Errors = Literal["robust", "independent", "profile", "bootstrap"]
ERRORS: tuple[str, ...] = get_args(Errors)
#: A parameter is at its bound within this share of its range.
AT_BOUND = 1e-6
#: A parameter is identifiable if the others leave at least this share of its effect: more than
#: systematic errors of a recording, or more than rounding.
APART, APART_INDEPENDENT = 1e-4, 1e-8
#: A standard error above this share of the value makes a parameter poorly determined.
POOR = 0.5


@dataclass(frozen=True)
class Estimate:
    """One identified parameter: value, standard error and 95 % interval in `unit`.

    A parameter that was `held` was not identified and has no standard error. `why` states for a
    parameter that is not `identifiable` which others have the same effect. `open` lists the ends of
    the interval, ``"lower"`` or ``"upper"``, that the data does not determine: they are at a bound
    of the parameter, or infinite.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(2000) / 100.0
    >>> v = np.sin(3.0 * t)
    >>> tau = 0.5 * v + 2.0 * np.sign(v) + np.random.default_rng(1).normal(0.0, 0.1, t.size)
    >>> r = sb.Recording.from_columns(time=t, velocity=v, torque=tau)
    >>> found = sb.fit("coulomb", r, starts=1).estimates["coulomb_friction"]
    >>> round(found.value, 1), found.unit, found.stderr < 0.02
    (2.0, 'N m', True)
    >>> low, high = found.ci95
    >>> low < 2.0 < high
    True
    """

    name: str
    symbol: str
    value: float
    unit: str
    stderr: float | None
    ci95: tuple[float, float] | None
    at_bound: bool
    identifiable: bool
    lower: float
    upper: float
    held: bool = False
    why: str | None = None
    open: tuple[str, ...] = ()

    @classmethod
    def symmetric(
        cls,
        parameter: Parameter,
        value: float,
        stderr: float | None,
        quantile: float,
        bounds: tuple[float, float],
        *,
        at_bound: bool,
        identifiable: bool,
        held: bool = False,
        why: str | None = None,
    ) -> Estimate:
        """An estimate whose interval reaches `quantile` standard errors to both sides."""
        reach = None if stderr is None else quantile * stderr
        return cls(
            name=parameter.name,
            symbol=parameter.symbol,
            value=value,
            unit=parameter.unit,
            stderr=stderr,
            ci95=None if reach is None else (value - reach, value + reach),
            at_bound=at_bound,
            identifiable=identifiable,
            lower=bounds[0],
            upper=bounds[1],
            held=held,
            why=why,
        )

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "symbol": self.symbol,
            "value": self.value,
            "unit": self.unit,
            "stderr": self.stderr,
            "ci95": [_finite(end) for end in self.ci95] if self.ci95 else None,
            "ci95_open": list(self.open),
            "at_bound": self.at_bound,
            "identifiable": self.identifiable,
            "held": self.held,
            "why": self.why,
        }


@dataclass(frozen=True)
class Identified:
    """All parameters of a fit, and how their errors depend on each other.

    Attributes
    ----------
    estimates
        By name.
    covariance
        Of the parameters that have a standard error.
    combinations
        What the data determines of the parameters that are not identifiable.
    rank
        Number of parameters, or combinations of them, that the data determines.
    notes
        What a reader has to know of the intervals.
    """

    estimates: dict[str, Estimate]
    covariance: ParameterMatrix
    combinations: tuple[Combination, ...]
    rank: int
    notes: tuple[str, ...] = ()


def poorly_determined(estimates: Iterable[Estimate]) -> list[str]:
    """Names of the parameters whose standard error is large beside the value.

    A coefficient of a series, such as ``position_3``, is judged beside the largest of the series: a
    small one says that the shape does not need it.
    """
    rows = list(estimates)
    size: dict[str, float] = {}
    for e in rows:
        size[_series(e.name)] = max(size.get(_series(e.name), 0.0), abs(e.value))
    return [
        e.name
        for e in rows
        if e.stderr is not None and e.identifiable and e.stderr > POOR * size[_series(e.name)]
    ]


def _series(name: str) -> str:
    """The name without its number: that of a series of coefficients."""
    stem, _, number = name.rpartition("_")
    return stem if stem and number.isdigit() else name


def estimates_by_rows(
    model: Model,
    values: Array,
    lower: Array,
    upper: Array,
    jacobian: Array,
    residual: Array,
    batch: NDArray[np.uint32] | None,
) -> Identified:
    """The parameters, from the problem linearised at the solution.

    Parameters
    ----------
    jacobian, residual : arrays [n, p] and [n]
        One row a sample, or the triangular factors of each batch: they have the same sums.
    batch : int array [n]
        Contiguous batches, from whose sums of scores the standard errors follow; None: errors are
        independent.
    """
    apart = APART_INDEPENDENT if batch is None else APART
    held = lower == upper
    at_bound = ~held & reached(values, lower, upper)
    shown = seen(jacobian, ~held, apart)
    covariance, freedom = covariance_of(jacobian, residual, batch, ~held & ~at_bound, apart)
    known = shown & ~at_bound
    quantile = float(scipy.special.stdtrit(freedom, 0.975))
    names = model.names
    made = {}
    for k, p in enumerate(model.parameters):
        error = float(np.sqrt(covariance[k, k])) if known[k] else None
        value = float(values[k])
        made[p.name] = Estimate.symmetric(
            p,
            value,
            error,
            quantile,
            (float(lower[k]), float(upper[k])),
            at_bound=bool(at_bound[k]),
            identifiable=bool(shown[k]),
            held=bool(held[k]),
            why=None if shown[k] or held[k] else reason(names, partners(jacobian, k, ~held)),
        )
    chosen = np.flatnonzero(known)
    among = ParameterMatrix(tuple(names[k] for k in chosen), covariance[np.ix_(chosen, chosen)])
    directions = Directions.of(jacobian, ~held)
    found = directions.combinations(apart, held.size)
    total = (
        covariance
        if not at_bound.any()
        else (covariance_of(jacobian, residual, batch, ~held, apart)[0])
    )
    rank = directions.rank(apart)
    return Identified(made, among, _combinations(model, values, found, total), rank)


def _combinations(
    model: Model, values: Array, found: Array, covariance: Array
) -> tuple[Combination, ...]:
    """The determined combinations, from their coefficients [d, p]."""
    made = []
    for row in found:
        # A combination in the unit of torque, where there is one, is the easiest to read.
        torques = (model.parameters[k].unit == model.torque_unit for k in np.flatnonzero(row))
        among = np.flatnonzero(row)[np.argsort([not t for t in torques], kind="stable")]
        scaled = row / row[among[0]]
        chosen = [model.parameters[k] for k in among]
        made.append(
            Combination(
                {p.name: float(scaled[k]) for p, k in zip(chosen, among, strict=True)},
                float(scaled @ values),
                float(np.sqrt(max(float(scaled @ covariance @ scaled), 0.0))),
                chosen[0].unit,
                len({p.unit for p in chosen}) == 1,
                not all(p.linear for p in chosen),
            )
        )
    return tuple(made)


def reached(values: Array, lower: Array, upper: Array) -> NDArray[np.bool_]:
    """Which values are at a bound, bool array [p]; an infinite bound is never reached."""
    size = np.where(np.isfinite(upper - lower), upper - lower, np.maximum(np.abs(values), 1.0))
    return np.asarray((values <= lower + AT_BOUND * size) | (values >= upper - AT_BOUND * size))


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None

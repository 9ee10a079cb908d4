"""Why a parameter is not identifiable, and which combinations of parameters are determined."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear

Array = NDArray[np.float64]

#: Least share of a parameter's effect that another must have to be named.
LEAST_SHARE = 0.05
#: Coefficients of parameters in one unit are shown as fractions with denominators up to this, if
#: all of them are fractions to the relative precision `ROUNDED`.
DENOMINATOR, ROUNDED = 12, 1e-3


@dataclass(frozen=True)
class Combination:
    """A combination of parameters that the data determines although these are not identifiable.

    Attributes
    ----------
    coefficients
        By name of the parameter; the first is 1.
    value, stderr : float
        Of the combination in `unit`, that of the first parameter.
    same_unit
        Whether all parameters have the same unit.
    local
        Whether the prediction is nonlinear in one of the parameters: the combination then holds
        near the values of the fit only.

    Examples
    --------
    >>> Combination({"a": 1.0, "b": 0.5}, 3.0, 0.1, "N m", True, False).text
    '2 a + b'
    >>> Combination({"a": 1.0, "b": -0.5}, 3.0, 0.1, "N m", False, False).text
    'a - 0.5 b'
    """

    coefficients: Mapping[str, float]
    value: float
    stderr: float
    unit: str
    same_unit: bool
    local: bool

    @property
    def factor(self) -> int:
        """The whole number by which `text` multiplies the coefficients, to show no fractions."""
        if not self.same_unit:
            return 1
        fractions = [_fraction(c) for c in self.coefficients.values()]
        known = [f.denominator for f in fractions if f is not None]
        return math.lcm(*known) if len(known) == len(fractions) else 1

    @property
    def text(self) -> str:
        """The combination as a sum; coefficients with three digits or as small whole numbers."""
        made = ""
        for name, coefficient in self.coefficients.items():
            shown = f"{self.factor * abs(coefficient):.3g}"
            term = name if shown == "1" else f"{shown} {name}"
            sign = "-" if coefficient < 0.0 else "+"
            made += f" {sign} {term}" if made else term
        return made

    def to_dict(self) -> dict[str, object]:
        """As JSON; value and standard error are those of `text`."""
        factor = self.factor
        return {
            "combination": self.text,
            "coefficients": {name: factor * c for name, c in self.coefficients.items()},
            "value": factor * self.value,
            "stderr": factor * self.stderr,
            "unit": self.unit,
            "local": self.local,
        }


def _fraction(value: float) -> Fraction | None:
    """A simple fraction that `value` nearly is."""
    near = Fraction(value).limit_denominator(DENOMINATOR)
    return near if abs(float(near) - value) <= ROUNDED * abs(value) else None


def partners(jacobian: Array, parameter: int, free: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Parameters that together have the same effect as one parameter, the strongest first.

    Parameters
    ----------
    jacobian : array [n, p]
        Derivative of the prediction.
    parameter
        Index of a parameter that is not identifiable.
    free : bool array [p]
        Parameters that a fit may change.

    Returns
    -------
    int array
        Indices of the others; empty where the prediction does not depend on the parameter.

    Examples
    --------
    >>> v = np.array([1.0, 2.0, 3.0])
    >>> jacobian = np.column_stack([v, np.ones(3), v - 1.0])
    >>> partners(jacobian, 0, np.ones(3, dtype=bool)).tolist()
    [2, 1]
    """
    size = np.sqrt(np.einsum("ij,ij->j", jacobian, jacobian))
    others = np.flatnonzero(free & (size > 0))
    others = others[others != parameter]
    if size[parameter] == 0 or others.size == 0:
        return np.zeros(0, dtype=np.intp)
    columns = jacobian[:, others] / size[others]
    shares = linear.least_norm(columns, jacobian[:, parameter] / size[parameter], 1e-10)
    order = np.argsort(-np.abs(shares), kind="stable")
    return np.asarray(others[order][np.abs(shares[order]) >= LEAST_SHARE])


def reason(names: tuple[str, ...], found: NDArray[np.intp]) -> str:
    """Why a parameter is not identifiable, from its `partners`; without full stop."""
    if found.size == 0:
        return "the prediction does not depend on it at the values of the other parameters"
    *most, last = (names[k] for k in found)
    together = f"{', '.join(most)} and {last} together have" if most else f"{last} has"
    return f"on this data {together} the same effect on the prediction"

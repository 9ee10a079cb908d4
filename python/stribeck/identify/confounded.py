"""Why a parameter is not identifiable: which others have the same effect on the prediction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Least share of a parameter's effect that another must have to be named.
LEAST_SHARE = 0.05


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
    shares = np.linalg.lstsq(columns, jacobian[:, parameter] / size[parameter], rcond=1e-10)[0]
    order = np.argsort(-np.abs(shares), kind="stable")
    return np.asarray(others[order][np.abs(shares[order]) >= LEAST_SHARE])


def reason(names: tuple[str, ...], found: NDArray[np.intp]) -> str:
    """Why a parameter is not identifiable, from its `partners`; without full stop."""
    if found.size == 0:
        return "the prediction does not depend on it at the values of the other parameters"
    *most, last = (names[k] for k in found)
    together = f"{', '.join(most)} and {last} together have" if most else f"{last} has"
    return f"on this data {together} the same effect on the prediction"

"""Why the data cannot show a parameter: what else has the same effect on the prediction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: A partner makes up at least this share of a parameter's effect.
LEAST_SHARE = 0.05


def partners(jacobian: Array, parameter: int, free: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Parameters that together do what one parameter does, the strongest first.

    Parameters
    ----------
    jacobian : array [n, p]
        Derivative of the prediction.
    parameter
        Index of one that the data does not show apart from the others.
    free : bool array [p]
        Those that a fit may change.

    Returns
    -------
    int array
        Indices; empty where the prediction does not depend on the parameter at all.

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
    """The sentence, without full stop, for the `partners` that were `found`."""
    if found.size == 0:
        return "the prediction does not depend on it where the other parameters stand"
    *most, last = (names[k] for k in found)
    together = f"{', '.join(most)} and {last} together do" if most else f"{last} does"
    return f"on this data {together} the same to the prediction"

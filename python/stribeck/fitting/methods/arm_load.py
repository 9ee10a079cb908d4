"""The load torque of a planar two-joint arm with known inertia (Indri et al., eqs 4 and 9)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck.base.arguments import door
from stribeck.base.checks import check_number
from stribeck.base.errors import SpecError
from stribeck.fitting.methods.arm import INERTIAL, rigid_body_columns

Array = NDArray[np.float64]


@door()
def planar_arm_load(
    inertia: ArrayLike,
    position: ArrayLike,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    *,
    first_link_length: float,
) -> Array:
    """Torques of both joints without friction, ``M(q) dv/dt + C(q, v) v``.

    Measured torque minus this is friction (eq 9): a column ``load_torque`` for `stribeck.read`.

    Parameters
    ----------
    inertia : array [4]
        ``Gamma_1z + m2 l1^2`` [kg m2], ``m2 s_2x`` and ``m2 s_2y`` [kg m], ``Gamma_2z`` [kg m2], as
        in eqs 12 to 15.
    position, velocity, acceleration : arrays [n, 2]
        rad, rad/s, rad/s2; the second angle is relative to the first link.
    first_link_length : float
        Distance between the axes, m.

    Returns
    -------
    array [n, 2], N m

    Raises
    ------
    SpecError
        Arrays of other shapes, or numbers that are not finite.

    Examples
    --------
    >>> nominal = [3.689, 0.97, 0.0, 0.275]
    >>> planar_arm_load(nominal, [[0.0, 0.0]], [[0.0, 0.0]], [[1.0, 0.0]], first_link_length=0.35)
    array([[4.643 , 0.6145]])
    """
    check_number("first_link_length", first_link_length, 0.0)
    try:
        terms = np.asarray(inertia, dtype=np.float64)
        q, v, a = (np.asarray(x, dtype=np.float64) for x in (position, velocity, acceleration))
    except (TypeError, ValueError):
        raise SpecError("inertia, position, velocity and acceleration must be numbers") from None
    if terms.shape != (len(INERTIAL),):
        raise SpecError(f"the inertia has the shape {list(terms.shape)}: give four numbers")
    if q.ndim != 2 or q.shape[1] != 2 or not q.shape == v.shape == a.shape:
        shapes = ", ".join(str(list(part.shape)) for part in (q, v, a))
        raise SpecError(f"position, velocity and acceleration are {shapes}: give arrays [n, 2]")
    if not all(np.isfinite(part).all() for part in (terms, q, v, a)):
        raise SpecError("a number is not finite: give finite angles, speeds and inertia")
    return np.asarray(rigid_body_columns(q, v, a, first_link_length) @ terms)

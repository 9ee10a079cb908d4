"""Inertia and friction of a planar two-joint arm, identified together by linear least squares.

Indri et al., "Nonlinear friction estimation for digital control of direct-drive manipulators",
section 4.2: eqs 4 and 10-15. The second joint's angle is relative to the first link, the arm moves
in the horizontal plane. The torques are linear in four inertial parameters and in four friction
coefficients per joint (eq 12 lists five, eq 14 has four: eq 10 has no a4).

Two options go beyond the paper. Each joint's equation is weighted by its error; otherwise the
larger torques of the first joint dominate the parameters that both share (Gautier 1997). And
samples slower than a share of the top speed are left out: there dry friction follows a Stribeck
curve, which a cubic polynomial does not fit, so that the inertial terms would be biased.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.base.shown import Shown
from stribeck.identify.errors.covariance import batches, correlation_length, sandwich, seen
from stribeck.identify.figures import rms
from stribeck.identify.normal import NormalEquations, solve_bounded
from stribeck.models.build import model
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights

Array = NDArray[np.float64]

#: Iterations in which weights follow from errors and errors from weights.
WEIGHINGS = 5
#: Name, symbol, unit and meaning of the parameters, in the order of eq 12.
INERTIAL = (
    ("inertia_1", "Gamma_1z + m2 l1^2", "kg m2", "link 1, with link 2 at its end"),
    ("moment_2x", "m2 s_2x", "kg m", "link 2, first moment along it"),
    ("moment_2y", "m2 s_2y", "kg m", "link 2, first moment across it"),
    ("inertia_2", "Gamma_2z", "kg m2", "link 2, about its joint"),
)
FRICTION = (
    ("coulomb", "a0", "N m", "friction by sgn v"),
    ("viscous", "a1", "N m s/rad", "friction by v"),
    ("quadratic", "a2", "N m s2/rad2", "friction by v^2 sgn v"),
    ("cubic", "a3", "N m s3/rad3", "friction by v^3"),
)


@dataclass(frozen=True)
class ArmParameter:
    """One identified parameter of the arm: value and standard error in `unit`."""

    name: str
    symbol: str
    value: float
    stderr: float
    unit: str
    description: str


@dataclass(frozen=True)
class ArmEvaluated:
    """The errors of an arm on a recording that it was not fitted to.

    Attributes
    ----------
    file
        As sentences name the recording.
    rmse
        Of each joint, over all samples, N m.
    relative_residual
        RMS of the torque error over RMS of the measured torque, of each joint.
    """

    file: str
    rmse: tuple[float, float]
    relative_residual: tuple[float, float]


@dataclass(frozen=True, repr=False)
class ArmFit(Shown):
    """Inertial and friction parameters of a planar two-joint arm.

    Attributes
    ----------
    parameters : tuple of ArmParameter
        The twelve parameters of eq 14, in its order.
    relative_errors : tuple of two floats
        RMS of the torque error over RMS of the measured torque for each joint, over all samples
        (section 4.2).
    prediction : array [n, 2]
        Torque of every sample, N m.
    first_link_length : float
        The given l1, m: first moments are inversely proportional to it.
    """

    parameters: tuple[ArmParameter, ...]
    relative_errors: tuple[float, float]
    prediction: Array
    first_link_length: float
    recordings: tuple[Recording, Recording]
    rows: tuple[int, int]
    evaluated: tuple[ArmEvaluated, ...] = ()

    @property
    def values(self) -> Array:
        """The parameter vector of eq 14, array [12]."""
        return np.array([p.value for p in self.parameters])

    def on(self, first: Recording, second: Recording) -> ArmFit:
        """The fit with its errors on both joints of a recording that it was not fitted to.

        Raises
        ------
        FitError
            Times or units that do not fit, or a recording that the arm was fitted to.
        """
        _check(first, second, self.first_link_length, 0.0)
        if not set(self.recordings[0].hashes).isdisjoint(first.hashes):
            raise FitError(
                f"{first.path}: the arm is fitted to it, so that its error there judges nothing: "
                f"give another recording with {option('evaluate')}"
            )
        torque = np.column_stack([first.torque, second.torque])
        residual = torque - _regressor((first, second), self.first_link_length) @ self.values
        error = [rms(column) for column in residual.T]
        share = [e / rms(t) for e, t in zip(error, torque.T, strict=True)]
        made = ArmEvaluated(first.path, (error[0], error[1]), (share[0], share[1]))
        return replace(self, evaluated=(*self.evaluated, made))

    def friction(self, joint: int) -> Model:
        """The friction of joint 1 or 2 as a model: the law ``hao_a``, the polynomial of eq 10."""
        first = len(INERTIAL) + (joint - 1) * len(FRICTION)
        a0, a1, a2, a3 = self.values[first : first + len(FRICTION)]
        return model("hao_a", a1=a0, a2=a1, a3=a2, a4=a3)

    def to_dict(self) -> dict[str, object]:
        """The JSON of the command ``stribeck arm``."""
        return {
            "parameters": {
                p.name: {
                    "symbol": p.symbol,
                    "value": p.value,
                    "stderr": p.stderr,
                    "unit": p.unit,
                }
                for p in self.parameters
            },
            "relative_errors": list(self.relative_errors),
            "first_link_length": self.first_link_length,
            "rows": list(self.rows),
            **({"evaluated": [vars(e) for e in self.evaluated]} if self.evaluated else {}),
        }

    def to_frame(self) -> pl.DataFrame:
        """The parameters as a table."""
        return pl.DataFrame([vars(p) for p in self.parameters])


def arm_fit(
    first: Recording,
    second: Recording,
    *,
    first_link_length: float,
    slowest: float = 0.05,
    weighted: bool = True,
) -> ArmFit:
    """Identify inertia and friction of a planar two-joint arm together.

    Parameters
    ----------
    first, second : Recording
        Both joints over the same time: angles in rad, motor torques at the joints in N m. Missing
        speeds and accelerations are derived from angles by a zero-phase filter.
    first_link_length : float
        l1 in m, between the axes. Not identifiable: first moments are inversely proportional to it.
    slowest : float
        Share of each joint's top speed below which samples are left out, 0 to below 1.
    weighted : bool
        Weight each joint's equation by its error: RMS times the root of its correlation length.
        False, together with ``slowest=0``, is the least squares of the paper.

    Returns
    -------
    ArmFit

    Raises
    ------
    FitError
        Times, units or lengths that do not fit; a parameter that is not identifiable.

    Notes
    -----
    A joint's equation is used where that joint moves faster than its velocity noise: at rest
    friction is undetermined. Standard errors are valid for noise that is correlated in time.

    Examples
    --------
    >>> one, two = sb.read("arm.csv", joint="1"), sb.read("arm.csv", joint="2")  # doctest: +SKIP
    >>> arm_fit(one, two, first_link_length=0.35).values[:4]  # doctest: +SKIP
    """
    refuse_weights("the identification of an arm", first, second)
    _check(first, second, first_link_length, slowest)
    joints = (first, second)
    columns = _regressor(joints, first_link_length)
    torque = np.column_stack([r.torque for r in joints])
    used = np.column_stack([_fast_enough(r, slowest) for r in joints])
    values, stderr = _least_squares(columns, torque, used, first, weighted)
    prediction = columns @ values
    errors = [rms(e) / rms(t) for e, t in zip((torque - prediction).T, torque.T, strict=True)]
    return ArmFit(
        parameters=_parameters(values, stderr),
        relative_errors=(errors[0], errors[1]),
        prediction=prediction,
        first_link_length=first_link_length,
        recordings=joints,
        rows=(int(used[:, 0].sum()), int(used[:, 1].sum())),
    )


def rigid_body_columns(
    position: Array, velocity: Array, acceleration: Array, first_link_length: float
) -> Array:
    """Derivatives of both joints' torques by the four inertial parameters, array [n, 2, 4].

    From the kinetic energy Theta1 v1^2/2 + Gamma2 w^2/2 + l1 v1 w (sx cos q2 - sy sin q2) with
    w = v1 + v2 and the first moments sx, sy of the second link in its own frame.

    Parameters
    ----------
    position, velocity, acceleration : array [n, 2]
        In rad, rad/s, rad/s2; the second angle is relative to the first link.
    first_link_length : float
        In m.
    """
    cosine, sine = np.cos(position[:, 1]), np.sin(position[:, 1])
    v1, v2 = velocity.T
    a1, a2 = acceleration.T
    both = a1 + a2
    coupled, whirl = 2.0 * a1 + a2, v2 * (2.0 * v1 + v2)
    zero = np.zeros_like(a1)
    length = first_link_length
    upon_first = [
        a1,
        length * (coupled * cosine - whirl * sine),
        -length * (coupled * sine + whirl * cosine),
        both,
    ]
    upon_second = [
        zero,
        length * (a1 * cosine + v1**2 * sine),
        length * (v1**2 * cosine - a1 * sine),
        both,
    ]
    return np.stack([np.column_stack(upon_first), np.column_stack(upon_second)], axis=1)


def friction_columns(velocity: Array) -> Array:
    """Derivatives of a joint's friction (eq 10) by a0 to a3, array [n, 4]; velocity in rad/s."""
    sign = np.sign(velocity)
    return np.column_stack([sign, velocity, sign * velocity**2, velocity**3])


def _angles(recording: Recording) -> Array:
    assert recording.position_smooth is not None, "checked before"
    return recording.position_smooth


def _regressor(joints: Sequence[Recording], first_link_length: float) -> Array:
    """D of eq 11 at every sample, array [n, 2, 12]."""
    position = np.column_stack([_angles(r) for r in joints])
    velocity = np.column_stack([r.velocity_smooth for r in joints])
    acceleration = np.column_stack([r.acceleration_smooth for r in joints])
    inertial, count = len(INERTIAL), len(FRICTION)
    columns = np.zeros((velocity.shape[0], 2, inertial + 2 * count))
    columns[:, :, :inertial] = rigid_body_columns(
        position, velocity, acceleration, first_link_length
    )
    for k in range(2):
        first = inertial + k * count
        columns[:, k, first : first + count] = friction_columns(velocity[:, k])
    return columns


def _fast_enough(recording: Recording, slowest: float) -> NDArray[np.bool_]:
    """The samples at which a joint's equation is used, bool array [n]."""
    return recording.moving & (
        np.abs(recording.velocity_smooth) > slowest * recording.scales()["speed"]
    )


def _least_squares(
    columns: Array,
    torque: Array,
    used: NDArray[np.bool_],
    recording: Recording,
    weighted: bool,
) -> tuple[Array, Array]:
    """Parameters and standard errors from the `used` samples of each joint, arrays [12]."""
    everything = np.ones(columns.shape[2], dtype=bool)
    shown = seen(columns[used], everything)
    if not shown.all():
        names = [row[0] for row, seen_here in zip(_table(), shown, strict=True) if not seen_here]
        raise FitError(
            f"{recording.path}: {', '.join(names)} cannot be distinguished from the other "
            f"parameters with this motion: move both joints over a wide range of angles, speeds "
            f"and accelerations"
        )
    free = np.full(columns.shape[2], np.inf)
    weight = np.ones(2)
    for _ in range(WEIGHINGS if weighted else 1):
        scaled = np.ascontiguousarray((columns * weight[:, None])[used])
        target = (torque * weight)[used]
        values = solve_bounded(*NormalEquations.of(scaled, target).total(), -free, free)
        residual = torque - columns @ values
        each = [residual[rows, k] for k, rows in enumerate(used.T)]
        # White noise averages out, so it has less weight than an error of the friction polynomial.
        lasting = [rms(r) * np.sqrt(correlation_length(r)) for r in each]
        weight = 1.0 / np.maximum(lasting, np.finfo(float).tiny)
    batch = batches(torque.shape[0], max(correlation_length(r) for r in each))
    # The errors of both joints at one time belong to one batch.
    together = np.repeat(batch[:, None], 2, axis=1)[used]
    covariance = sandwich(scaled, target - scaled @ values, together, everything)
    return values, np.sqrt(np.diag(covariance))


def _parameters(values: Array, stderr: Array) -> tuple[ArmParameter, ...]:
    return tuple(
        ArmParameter(name, symbol, float(value), float(error), unit, description)
        for (name, symbol, unit, description), value, error in zip(
            _table(), values, stderr, strict=True
        )
    )


def _table() -> list[tuple[str, str, str, str]]:
    """Name, symbol, unit and meaning of the twelve parameters."""
    friction = [
        (f"{name}_{joint}", f"{symbol}{joint}", unit, f"joint {joint}, {description}")
        for joint in (1, 2)
        for name, symbol, unit, description in FRICTION
    ]
    return [*INERTIAL, *friction]


def _check(first: Recording, second: Recording, length: float, slowest: float) -> None:
    path = first.path
    if not 0.0 <= slowest < 1.0:
        raise FitError(f"{option('slowest', slowest)} is out of range: give a share, 0 to below 1")
    if not (np.isfinite(length) and length > 0.0):
        raise FitError(
            f"{option('first_link_length', length)} is not a length: give metres above 0"
        )
    for r in (first, second):
        if r.position is None:
            raise FitError(f"{path}: joint {r.joint} has no position column: an arm needs angles")
        if r.joint_kind != "revolute" or r.torque_unit != "N m":
            raise FitError(
                f"{path}: joint {r.joint} is {r.joint_kind} with a torque in {r.torque_unit}, and "
                f"an arm needs revolute joints with torques in N m"
            )
        if r.averaged:
            raise FitError(f"{path}: an arm is identified in motion, not from averaged runs")
    if not np.array_equal(first.time, second.time):
        raise FitError(
            f"{path}: joints {first.joint} and {second.joint} were not sampled at the same times: "
            f"give one file with the columns of both side by side"
        )

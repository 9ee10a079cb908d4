"""Channels of a call, as contiguous columns of one length for the compiled core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any, TypeAlias, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.errors import SpecError, nearest

Array = NDArray[np.float64]

#: Channels as keyword arguments of a compiled model.
ChannelArguments: TypeAlias = dict[str, Any]

#: Channels that a model may read, other than the velocity.
OTHER_CHANNELS = (
    "position",
    "acceleration",
    "temperature",
    "load_torque",
    "motor_torque",
    "external_torque",
    "time",
    "load_torque_curvature",
    "temperature_rate",
)


#: Effects that belong to the rigid body when it is identified together with the friction.
RIGID_BODY_EFFECTS = ("inertia", "gravity")
#: Channels that follow from the balance of torques, or from the load torque, where they can.
FOLLOWING = ("motor_torque", "external_torque")


class Columns(TypedDict):
    """Channels of n samples, in SI units and degC; None where one is not given."""

    dt: float | Array | None
    velocity: Array
    position: Array | None
    acceleration: Array | None
    temperature: Array | None
    load_torque: Array | None
    motor_torque: Array | None
    external_torque: Array | None
    time: Array | None
    load_torque_curvature: Array | None
    temperature_rate: Array | None


def columns(
    core: _core.Model,
    velocity: ArrayLike,
    dt: float | ArrayLike | None,
    others: Sequence[ArrayLike | None],
) -> Columns:
    """The channels of a call, each of the velocity's length.

    Parameters
    ----------
    core
        The model that reads them. Where it reads the external torque and none is given, that is
        minus the load torque.
    velocity : array [n]
        rad/s or m/s.
    dt : float or array [n]
        Step to the previous sample, s.
    others
        The other channels in the order of `OTHER_CHANNELS`, arrays [n] or numbers.
    """
    given = dict(zip(OTHER_CHANNELS, others, strict=True))
    speed = column("velocity", np.atleast_1d(velocity))

    def filled(name: str) -> Array | None:
        values = given[name]
        return None if values is None else column(name, values, speed.shape)

    external, load = filled("external_torque"), filled("load_torque")
    if external is None and load is not None and "external_torque" in core.needs:
        external = -load
    step: float | Array | None = None
    if dt is not None:
        alone = np.ndim(dt) == 0 and speed.size > 0
        steps = column("dt", dt, None if alone else speed.shape)
        if not np.isfinite(steps).all() or (steps < 0.0).any():
            raise SpecError("dt is not finite, or negative: give the steps in s")
        step = float(steps[0]) if alone else steps
    _refuse_missing(core, [name for name in core.needs if name in given and given[name] is None])
    return {
        "dt": step,
        "velocity": speed,
        "position": filled("position"),
        "acceleration": filled("acceleration"),
        "temperature": filled("temperature"),
        "load_torque": load,
        "motor_torque": filled("motor_torque"),
        "external_torque": external,
        "time": filled("time"),
        "load_torque_curvature": filled("load_torque_curvature"),
        "temperature_rate": filled("temperature_rate"),
    }


def _refuse_missing(core: _core.Model, names: Sequence[str]) -> None:
    """Refuse a call that lacks several channels, with the names of all; the core tells of one.

    Raises
    ------
    SpecError
        Two or more are missing that do not follow from others.
    """
    plain = [name for name in names if name not in FOLLOWING]
    if len(plain) > 1:
        listed = ", ".join(f"'{name}'" for name in plain[:-1])
        body = [effect for effect in RIGID_BODY_EFFECTS if effect in core.effects]
        why = f": its {' and '.join(body)} were identified with its friction" if body else ""
        raise SpecError(f"the model needs the columns {listed} and '{plain[-1]}'{why}")


def split_columns(
    core: _core.Model,
    velocity: ArrayLike,
    given: Mapping[str, ArrayLike | None],
    box: Mapping[str, tuple[float, float]],
) -> dict[str, Array]:
    """The channels at which a steady torque is asked for, all of the longest one's length.

    A channel that is not given is at the middle of the operating `box`; the time is at the middle
    of the recording, the derivatives of load and temperature are 0.

    Raises
    ------
    SpecError
        A channel of another name, or one that is no array of numbers.
    """
    for name in given:
        if name not in OTHER_CHANNELS:
            hint = nearest(name, OTHER_CHANNELS) or f": give some of {', '.join(OTHER_CHANNELS)}"
            raise SpecError(f"there is no channel `{name}`{hint}")
    found = {"velocity": column("velocity", np.atleast_1d(velocity))}
    for name in OTHER_CHANNELS:
        values = given.get(name)
        if values is None:
            values = _usual(core, name, box)
        if values is not None:
            found[name] = column(name, np.atleast_1d(values))
    size = max(values.size for values in found.values())
    return {name: column(name, values, (size,)) for name, values in found.items()}


def _usual(core: _core.Model, name: str, box: Mapping[str, tuple[float, float]]) -> float | None:
    """The value of a channel that is not given; None where the model does without."""
    if name == "time" and name in core.needs:
        return 0.5 * core.constants["duration"]
    if name in ("load_torque_curvature", "temperature_rate") and name in core.needs:
        return 0.0
    return 0.5 * sum(box[name]) if name in box else None


def column(name: str, values: ArrayLike, shape: tuple[int, ...] | None = None) -> Array:
    """`values` of a channel as a contiguous array of numbers, repeated to `shape` if one is given.

    Raises
    ------
    SpecError
        They are no numbers (dates, texts and complex numbers are none), or not of this shape.
    """
    given = np.asanyarray(values)
    if given.dtype == object:
        numbers = all(isinstance(value, Real) for value in given.flat)
    else:
        numbers = given.dtype.kind in "fiu"
    if not numbers or given.ndim > 1 or isinstance(given, np.ma.MaskedArray):
        what = f"an array {list(given.shape)} of {given.dtype.name}"
        raise SpecError(f"{name} is {what}: give numbers, an array [n]")
    if shape is not None and given.shape not in ((), (1,), shape):
        raise SpecError(
            f"{name} has {given.size} samples where the others have {shape[0]}: give as many, or "
            f"one number"
        )
    repeated = given if shape is None else np.broadcast_to(given, shape)
    return np.ascontiguousarray(repeated, dtype=np.float64)


def constant(values: ArrayLike, size: int) -> Array:
    """A copy of `values` that cannot be written to; NaN [size] where they are not of this size."""
    copied = np.array(values, dtype=np.float64)
    if copied.shape != (size,):
        copied = np.full(size, np.nan)
    copied.setflags(write=False)
    return copied


def one_each(names: Sequence[str], values: ArrayLike) -> Array:
    """The values of parameters, array [p].

    Raises
    ------
    SpecError
        There are more or fewer values than parameters.
    """
    given = np.asarray(values, dtype=np.float64)
    if given.shape != (len(names),):
        raise SpecError(
            f"the model has {len(names)} parameters, {', '.join(names)}, and an array "
            f"{list(given.shape)} was given: give a value for each"
        )
    return given


def finite(result: Array, what: str) -> Array:
    """The result of a call, if all of it is finite.

    Raises
    ------
    SpecError
        The values lead beyond the range of numbers.
    """
    if not np.isfinite(result).all():
        sample = int(np.argwhere(~np.isfinite(result))[0][0])
        raise SpecError(
            f"{what} is not finite at sample {sample}: check the values given and their units"
        )
    return result

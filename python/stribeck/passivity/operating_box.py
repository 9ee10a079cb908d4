"""The box of operating points over which passivity is proved."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from stribeck.base.errors import SpecError, nearest, option
from stribeck.base.units import ABSOLUTE_ZERO
from stribeck.models.model import Model

Box = Mapping[str, tuple[float, float]]

#: Channels that can be sides of a box.
CHANNELS = (
    "velocity",
    "position",
    "acceleration",
    "temperature",
    "load_torque",
    "motor_torque",
    "external_torque",
    "time",
)


def parse_sides(texts: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Sides of a box from texts such as ``velocity=-3.14:3.14``.

    Raises
    ------
    SpecError
        A text of another form, or a channel that is given twice.
    """
    sides: dict[str, tuple[float, float]] = {}
    for text in texts:
        name, equals, span = text.partition("=")
        low, colon, high = span.partition(":")
        try:
            if not (equals and colon):
                raise ValueError
            ends = float(low), float(high)
        except ValueError:
            raise SpecError(
                f"{option('box', text)}: write {option('box', 'CHANNEL=LOW:HIGH')}, as in "
                f"velocity=-3.14:3.14"
            ) from None
        if name.strip() in sides:
            raise SpecError(f"{option('box', text)}: {name.strip()} is given twice, leave one out")
        sides[name.strip()] = ends
    return sides


def operating_box(friction: Model, given: Box) -> dict[str, tuple[float, float]]:
    """The sides that the friction reads: as given, else the model's, else from its constants.

    Parameters
    ----------
    friction
        A model without drive and rigid body.
    given
        (low, high) by channel, SI units and degC.

    Raises
    ------
    SpecError
        A side that is missing, unknown or not finite, or with its higher end first.
    """
    check_sides(given)
    constants = friction.core.constants
    known = dict(friction.box)
    if "duration" in constants:
        known.setdefault("time", (0.0, constants["duration"]))
    if "position_length" in constants:
        start = constants["position_start"]
        known.setdefault("position", (start, start + constants["position_length"]))
    known.update(given)
    needs = friction.core.needs
    for name in needs:
        if name not in known:
            raise SpecError(
                f"the box of {friction.spec} has no {name}, which its friction depends on: "
                f"give {option('box', f'{name}=LOW:HIGH')}"
            )
    box = {name: (float(known[name][0]), float(known[name][1])) for name in needs}
    check_sides(box)
    if box["velocity"] == (0.0, 0.0):
        raise SpecError("the box holds no motion: give velocity a range, as in velocity=-1:1")
    return box


def check_sides(box: Box) -> None:
    """Raise `SpecError` for a side that is unknown or not finite, or has its higher end first."""
    for name, (low, high) in box.items():
        _check_side(name, low, high)


def refuse_unread_sides(box: Box, spec: str, reads: Iterable[str]) -> None:
    """Raise `SpecError` for a given side that is invalid, or that nothing reads.

    Parameters
    ----------
    spec
        The model, as the sentence names it.
    reads
        The channels on which it depends.
    """
    check_sides(box)
    read = [name for name in CHANNELS if name in set(reads)]
    for name, (low, high) in box.items():
        if name not in read:
            given = option("box", f"{name}={low:g}:{high:g}")
            raise SpecError(
                f"{given} has no effect with {spec}, which depends on {', '.join(read)}, "
                f"only with a model that depends on {name}: omit it"
            )


def _check_side(name: str, low: float, high: float) -> None:
    if name not in CHANNELS:
        raise SpecError(
            f"the box cannot have {name!r}{nearest(name, CHANNELS)}; it can have "
            f"{', '.join(CHANNELS)}"
        )
    if not (math.isfinite(low) and math.isfinite(high)):
        raise SpecError(f"the box's {name} is {low:g}:{high:g}: give two finite numbers")
    if name == "temperature" and low < ABSOLUTE_ZERO:
        raise SpecError(
            f"the box's temperature is {low:g}:{high:g} degC, below absolute zero: give "
            f"{ABSOLUTE_ZERO} or more"
        )
    if low > high:
        raise SpecError(f"the box's {name} is {low:g}:{high:g}: give the lower end first")

"""Numbers that were given for a joint, and that its columns leave no use for: notes."""

from __future__ import annotations

from collections.abc import Iterator

from stribeck.base.errors import option
from stribeck.recording.joint.channels import Channels

__all__ = ["unused_numbers"]


def unused_numbers(data: Channels, kind: str) -> Iterator[str]:
    """A note for each number that changes nothing, with the reason; `kind` is that of the joint."""
    mechanics, choices = data.prepared.settings.mechanics, data.prepared.choices
    direct = next((c for c in ("friction_torque", "torque") if c in choices), "torque")
    # A current that was converted is the choice of the torque as well.
    is_read = direct in choices and choices[direct].channel == direct
    read_from = f"the torque is read from '{choices[direct].source}'" if is_read else ""
    if mechanics.torque_constant is not None and is_read and "current" not in choices:
        yield f"the torque constant {mechanics.torque_constant:g} is not used: {read_from}"
    if mechanics.gear_ratio != 1.0 and is_read and data.prepared.settings.torque_at is None:
        at_motor = option("torque_at", "motor")
        yield (
            f"the gear ratio {mechanics.gear_ratio:g} does not change the torque: {read_from} as "
            f"that of the joint (give {at_motor} if it is the motor's)"
        )
    if mechanics.screw_pitch is not None and kind == "revolute":
        yield f"the screw pitch {mechanics.screw_pitch:g} m is not used: the joint is revolute"
    if mechanics.terms and "load_torque" in choices:
        terms = ", ".join(f"{name} {value:g}" for name, value in mechanics.terms.items())
        source = choices["load_torque"].source
        yield f"not used: {terms}; the load torque is read from '{source}'"

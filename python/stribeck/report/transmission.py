"""What two encoders show of a transmission, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called
from stribeck.report.layout import bullets
from stribeck.report.numbers import plain

if TYPE_CHECKING:
    from stribeck.fitting.transmission.measure import Measured, Transmission


def transmission_text(transmission: Transmission | str, joint: str = "") -> str:
    """Stiffness, backlash, hysteresis, and the side on which friction acts."""
    heading = (
        f"Transmission{f' of {joint_called(joint)}' if joint else ''} (motor minus joint encoder):"
    )
    if isinstance(transmission, str):
        return bullets(heading, [f"cannot be measured: {transmission}"])
    t = transmission
    unit = t.backlash.unit
    rows = [
        f"windup: {plain(t.windup)} {unit}; {plain(t.resolution)} {unit} can be resolved",
        _quantity("stiffness", t.stiffness),
        _quantity("backlash", t.backlash),
        _quantity("hysteresis, half the width of the loop", t.hysteresis),
        _sides(t),
    ]
    if t.lag is not None:
        rows.append(
            f"the encoder of the joint is at least {plain(1e3 * t.lag)} ms behind that of the "
            "motor, which looks like windup"
        )
    return bullets(heading, rows)


def _quantity(name: str, measured: Measured) -> str:
    m = measured
    if m.value is not None:
        return f"{name}: {plain(m.value)} {m.unit} (95 %: {_ends(m)})"
    if m.low == 0.0 and m.high is not None:
        return f"{name}: {m.why}, at most {plain(m.high)} {m.unit}"
    between = ""
    if m.low and m.high:
        between = f" (between {plain(m.low)} and {plain(m.high)} {m.unit})"
    return f"{name}: cannot be told, {m.why}{between}"


def _ends(measured: Measured) -> str:
    low, high = measured.low, measured.high
    return f"{plain(low or 0.0)} to {'unknown' if high is None else plain(high)}"


def _sides(t: Transmission) -> str:
    """Whether friction acts in front of the transmission or behind it."""
    motor, whole = t.motor_coulomb, t.coulomb
    if motor.value is None:
        return _quantity("Coulomb friction on the side of the motor", motor)
    text = f"{_quantity('Coulomb friction on the side of the motor', motor)}"
    if t.motor_share is None or whole.value is None:
        return f"{text}; that of the whole joint cannot be told"
    rest = max(whole.value - motor.value, 0.0)
    return (
        f"{text}, {100.0 * t.motor_share:.0f} % of the {plain(whole.value)} {whole.unit} of the "
        f"joint; {plain(rest)} {whole.unit} act behind the transmission"
    )

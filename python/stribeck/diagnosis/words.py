"""Plain sentences: where the data shows an effect, with numbers and units."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.shape import ripple_period_of
from stribeck.fitting.result import Fit
from stribeck.models.catalog import catalog, effect_row
from stribeck.models.model import Model

Array = NDArray[np.float64]

#: Groups of effects whose cause is not friction.
ELSEWHERE = ("measurement", "actuator", "rigid body", "drive")


def number(value: float) -> str:
    """Three significant digits, without exponents for everyday sizes."""
    return f"{value:.3g}"


def where(effect: str, before: Fit, after: Fit) -> str:
    """One sentence that says where `effect` shows, from the fitted values and the data.

    Of a cause outside the friction it says so first.
    """
    own = after.model.formula(effect)
    if own is not None:
        found = (f"{n} = {number(after.model.value(n))}" for n in own.names)
        return f"{own.text} fits with {', '.join(found)}"
    sentence = SENTENCES[effect](before, after)
    return sentence if is_friction(effect) else f"this is not friction: {sentence}"


def is_friction(effect: str) -> bool:
    """Whether the cause lies in the friction; of an effect by formula that is taken for granted."""
    row = effect_row(effect)
    return row is None or row["group"] not in ELSEWHERE


def physically(effect: str, model: Model) -> str:
    """What the effect of a model is, in one sentence: the catalog's, or its formula."""
    own = model.formula(effect)
    return str(catalog()["effects"][effect]["what"]) if own is None else f"{effect} = {own.text}."


def _stribeck(before: Fit, after: Fit) -> str:
    m, unit = after.model, after.model.load_unit
    return (
        f"at low speed friction is {number(m.value('stribeck_height'))} {unit} higher than the "
        f"Coulomb level and falls to it around {number(m.value('stribeck_velocity'))} "
        f"{m.position_unit}/s"
    )


def _frictional_lag(before: Fit, after: Fit) -> str:
    m = after.model
    return (
        f"the fall of friction with speed comes {number(1e3 * m.value('frictional_lag'))} ms late: "
        f"at the same low speed friction is higher while the joint speeds up than while it slows "
        f"down"
    )


def _nonlinear_viscous(before: Fit, after: Fit) -> str:
    m = after.model
    top = max(abs(x) for x in m.box["velocity"])
    reference = m.constants["reference_velocity"]

    def part(speed: float) -> float:
        levelled = speed / reference / (1.0 + speed / m.value("nonlinear_viscous_saturation"))
        power = levelled ** m.value("nonlinear_viscous_exponent")
        return m.value("nonlinear_viscous_coefficient") * reference * power

    bends = "flattens" if part(0.5 * top) > 0.5 * part(top) else "steepens"
    return (
        f"the curve of friction against speed {bends}: the part that is not proportional to speed "
        f"is {number(part(0.5 * top))} {m.load_unit} at {number(0.5 * top)} and "
        f"{number(part(top))} {m.load_unit} at {number(top)} {m.position_unit}/s"
    )


def _direction(before: Fit, after: Fit) -> str:
    m = after.model
    top = max(abs(x) for x in m.box["velocity"])
    slope = m.value("direction_viscous")
    base = m.value("direction_coulomb") if "direction_coulomb" in m.names else 0.0
    return (
        f"friction in the two directions differs by {number(2 * abs(base))} {m.load_unit} near "
        f"rest and by {number(2 * abs(base + slope * top))} {m.load_unit} at {number(top)} "
        f"{m.position_unit}/s, larger "
        f"{'forward' if base + slope * top > 0 else 'backward'}"
    )


def _load(before: Fit, after: Fit) -> str:
    m = after.model
    low, high = m.box["load_torque"]
    most = max(abs(low), abs(high))
    reference = m.constants["reference_load"]
    part = m.value("load_coulomb") * reference * (most / reference) ** m.value("load_exponent")
    return (
        f"at the same speed friction is {number(part)} {m.load_unit} higher under "
        f"{number(most)} {m.load_unit} of load than without load"
    )


def _quadrant(before: Fit, after: Fit) -> str:
    m = after.model
    low, high = m.box["load_torque"]
    most = max(abs(low), abs(high))
    speed = 0.5 * max(abs(x) for x in m.box["velocity"])
    driving, driven = (
        float(m.split(speed, load_torque=np.array([sign * most]))["dry"][0]) for sign in (1, -1)
    )
    more = "higher" if driving > driven else "lower"
    return (
        f"under {number(most)} {m.load_unit} of load at {number(speed)} {m.position_unit}/s "
        f"friction is {number(abs(driving - driven))} {m.load_unit} {more} while the joint "
        f"drives the load than while the load drives the joint"
    )


def _at_temperatures(after: Fit, part: str) -> tuple[float, float, float, float]:
    m = after.model
    cold, hot = m.box["temperature"]
    low, high = m.box["velocity"]
    speed = 0.5 * max(abs(low), abs(high))
    split = m.split(speed, temperature=np.array([cold, hot]))
    return cold, hot, float(split[part][0]), float(split[part][1])


def _temperature(part: str) -> Callable[[Fit, Fit], str]:
    def sentence(before: Fit, after: Fit) -> str:
        cold, hot, at_cold, at_hot = _at_temperatures(after, part)
        m = after.model
        name = "viscous" if part == "rate" else "dry"
        more = "higher" if at_cold > at_hot else "lower"
        low, high = m.box["velocity"]
        speed = 0.5 * max(abs(low), abs(high))
        at = f" at {number(speed)} {m.position_unit}/s" if part == "rate" else ""
        return (
            f"{name} friction{at} is {number(abs(at_cold - at_hot))} {m.load_unit} {more} at "
            f"{number(cold)} degC than at {number(hot)} degC"
        )

    return sentence


def _presliding(before: Fit, after: Fit) -> str:
    m = after.model
    slow = 1e-3 * max(abs(x) for x in m.box["velocity"])
    distance = float(m.split(slow)["dry"][0]) / m.value("presliding_stiffness")
    return (
        f"after each reversal friction builds up over about {number(distance)} {m.position_unit} "
        f"of motion instead of jumping"
    )


def _position(before: Fit, after: Fit) -> str:
    m = after.model
    low, high = m.box["position"]
    q = np.linspace(low, high, 200)
    top = max(abs(x) for x in m.box["velocity"])
    dry = m.split(top, position=q)["dry"]
    at = float(q[int(np.argmax(dry))])
    return (
        f"dry friction varies by {number(float(np.ptp(dry)))} {m.load_unit} along the stroke and "
        f"is highest at {number(at)} {m.position_unit}, in both directions"
    )


def _drift(before: Fit, after: Fit) -> str:
    m = after.model
    start, end = 0.0, m.constants["duration"]
    top = max(abs(x) for x in m.box["velocity"])
    first, last = m.split(top, time=np.array([start, end]))["dry"]
    way = "falls" if last < first else "rises"
    return (
        f"dry friction {way} from {number(float(first))} to {number(float(last))} {m.torque_unit} "
        f"over the {number(end)} s of the recording, more than temperature explains"
    )


def _along_stroke(after: Fit) -> tuple[float, float, Array]:
    """Ends of the stroke, and 2000 positions between them."""
    low, high = after.model.box["position"]
    return low, high, np.linspace(low, high, 2000)


def _spring(before: Fit, after: Fit) -> str:
    m = after.model
    low, high, q = _along_stroke(after)
    constants = m.constants
    u = 2.0 * (q - constants["position_start"]) / constants["position_length"] - 1.0
    names = ("spring_linear", "spring_quadratic", "spring_cubic")
    size = np.ptp(np.polynomial.legendre.legval(u, [0.0, *(m.value(name) for name in names)]))
    return (
        f"what is left is a torque of position alone, the same in both directions, that varies by "
        f"{number(float(size))} {m.torque_unit} between {number(low)} and {number(high)} "
        f"{m.position_unit}"
    )


def _ripple(before: Fit, after: Fit) -> str:
    m = after.model
    period = ripple_period_of(m)
    first, second = (
        float(np.hypot(m.value(f"ripple_{part}cos"), m.value(f"ripple_{part}sin")))
        for part in ("", "second_")
    )
    turn = ""
    if after.recording.joint_kind == "revolute":
        turn = f" ({number(2.0 * np.pi / period)} to a turn)"
    return (
        f"a torque of {number(np.hypot(first, second))} {m.torque_unit} repeats every "
        f"{number(period)} {m.position_unit}{turn}, the same in both directions"
    )


def _backlash(before: Fit, after: Fit) -> str:
    m = after.model
    speed = m.constants["reference_velocity"]
    return (
        f"after the load torque changes its sign the motor does not carry it for about "
        f"{number(m.value('backlash_gap'))} {m.position_unit} of motion at {number(speed)} "
        f"{m.position_unit}/s"
    )


def _elasticity(before: Fit, after: Fit) -> str:
    share = after.model.value("elasticity")
    side = "motor" if share > 0 else "joint"
    hertz = 1.0 / (2.0 * np.pi * np.sqrt(max(abs(share), np.finfo(float).tiny)))
    return (
        f"what is left follows the second derivative of the load torque, as if the inertia of the "
        f"{side} swung on the drive train at {number(float(hertz))} Hz"
    )


def _gain(before: Fit, after: Fit) -> str:
    m = after.model
    share = m.value("gain")
    low, high = m.box["load_torque"]
    most = max(abs(low), abs(high))
    error = "too much" if share > 0 else "too little"
    return (
        f"the torque channel shows {number(100 * abs(share))} % {error} of all torque, "
        f"{number(abs(share) * most)} {m.load_unit} under {number(most)} "
        f"{m.load_unit} of load, at any speed"
    )


def _saturation(before: Fit, after: Fit) -> str:
    m = after.model
    top = m.constants["reference_torque"]
    return (
        f"at {number(top)} {m.load_unit} the torque channel shows "
        f"{number(100 * m.value('saturation'))} % more than the motor yields, and "
        f"{number(100 * m.value('saturation') * 0.5 ** m.value('saturation_exponent'))} % at half "
        f"of it"
    )


def _offset(before: Fit, after: Fit) -> str:
    m = after.model
    return (
        f"the torque is shifted by {number(m.value('offset'))} {m.load_unit}, the same in both "
        f"directions"
    )


def _inertia(before: Fit, after: Fit) -> str:
    m = after.model
    name = next(n for n in m.names if n == "inertia")
    unit = next(p.unit for p in m.parameters if p.name == name)
    value = m.value(name)
    return (
        f"what is left grows with acceleration, as if {number(abs(value))} {unit} of inertia were "
        f"{'missing from' if value > 0 else 'too much in'} the load torque"
    )


def _gravity(before: Fit, after: Fit) -> str:
    m = after.model
    size = float(np.hypot(m.value("gravity_cos"), m.value("gravity_sin")))
    return (
        f"what is left follows the angle like a weight of {number(size)} {m.load_unit} that the "
        f"load torque does not hold"
    )


def _delay(before: Fit, after: Fit) -> str:
    tau = after.model.value("delay")
    way = "lags behind" if tau > 0 else "leads"
    samples = abs(tau) * after.recording.rate_hz
    return (
        f"the torque {way} the motion by {number(1e3 * abs(tau))} ms ({number(samples)} samples), "
        f"most visible at reversals"
    )


SENTENCES: dict[str, Callable[[Fit, Fit], str]] = {
    "stribeck": _stribeck,
    "frictional_lag": _frictional_lag,
    "nonlinear_viscous": _nonlinear_viscous,
    "direction": _direction,
    "load": _load,
    "quadrant": _quadrant,
    "temperature_viscous": _temperature("rate"),
    "temperature_dry": _temperature("dry"),
    "presliding": _presliding,
    "position": _position,
    "drift": _drift,
    "spring": _spring,
    "ripple": _ripple,
    "backlash": _backlash,
    "elasticity": _elasticity,
    "saturation": _saturation,
    "gain": _gain,
    "offset": _offset,
    "inertia": _inertia,
    "gravity": _gravity,
    "delay": _delay,
}

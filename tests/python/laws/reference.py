"""Static friction laws as lists of terms at 50 digits, with all their derivatives.

Each function returns the terms whose sum is the friction torque, written from the papers (seeds
of the project; the UR5e review of 2024/25 numbers most of them a1, a2 ...). Parameters go by the
symbol of the paper, inputs by

    v velocity, T temperature, tl load torque, tm motor torque, te external torque,
    a acceleration, q position

and fixed constants by the name in the catalog.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from mpmath import mp, mpf

from laws.dual import (
    Beyond,
    Dual,
    atan,
    cbrt,
    exp,
    magnitude,
    plain,
    power,
    sigmoid,
    sign,
    sqrt,
    tanh,
    variable,
)

#: Letter of each channel of a recording.
LETTERS = {
    "velocity": "v",
    "temperature": "T",
    "load_torque": "tl",
    "motor_torque": "tm",
    "external_torque": "te",
    "acceleration": "a",
    "position": "q",
}

Terms = Callable[[Any, Any], list[Dual]]

#: The terms of every static law, by id.
STATIC: dict[str, Terms] = {}

#: The terms as printed, where `STATIC` has joined some to show that they cancel at rest. Their
#: derivatives by the parameters do not cancel and are judged one by one.
PRINTED: dict[str, Terms] = {}


def law(of: Terms) -> Terms:
    """Enter a law under the name of its function."""
    STATIC[of.__name__] = of
    return of


@dataclass(frozen=True)
class Evaluated:
    """A law at one point.

    Attributes
    ----------
    value
        The torque.
    gradient
        Its derivative by each quantity: parameters, inputs, constants.
    size
        ``sum |terms| + sum |p df/dp|`` over all quantities: to first order, what relative
        errors of one unit in each term and each given number do to the torque.
    """

    value: mpf
    gradient: dict[str, mpf]
    size: mpf


def evaluate(terms: Terms, parameters: Mapping[str, Any], inputs: Mapping[str, Any]) -> Evaluated:
    """The law at one point, parameters by symbol and inputs by letter or name of constant."""
    numbers = {**parameters, **inputs}
    parts = _parts(terms, parameters, inputs)
    total = sum(parts, Dual(0))
    size = sum((abs(part.value) for part in parts), mpf(0))
    size += sum((abs(numbers[name] * d) for name, d in total.slope.items()), mpf(0))
    return Evaluated(total.value, {name: total.slope.get(name, mpf(0)) for name in numbers}, size)


def gradient_size(
    terms: Terms, parameters: Mapping[str, Any], inputs: Mapping[str, Any]
) -> dict[str, mpf]:
    """The scale of the error of each parameter's derivative.

    For parameter ``j``: ``sum_k |d term_k/dp_j| + sum_i |p_i d2f/dp_i dp_j|`` over all
    quantities ``i``, the same first-order bound as `Evaluated.size` for the derivative instead of
    the torque. Second derivatives are difference quotients of the exact first ones, 1e-20 apart.
    """
    step = mpf(10) ** -20
    here = _parts(terms, parameters, inputs)
    total = sum(here, Dual(0)).slope
    size = {
        name: sum((abs(part.slope.get(name, mpf(0))) for part in here), mpf(0))
        for name in parameters
    }
    for moved, numbers in ((n, group) for group in (parameters, inputs) for n in group):
        if numbers[moved] == 0:
            continue
        there = {**numbers, moved: mpf(numbers[moved]) * (1 + step)}
        pair = (there, inputs) if numbers is parameters else (parameters, there)
        slope = sum(_parts(terms, *pair), Dual(0)).slope
        for name in parameters:
            size[name] += abs(slope.get(name, mpf(0)) - total.get(name, mpf(0))) / step
    return size


def _parts(terms: Terms, parameters: Mapping[str, Any], inputs: Mapping[str, Any]) -> list[Dual]:
    def named(numbers: Mapping[str, Any]) -> SimpleNamespace:
        return SimpleNamespace(**{name: variable(name, x) for name, x in numbers.items()})

    parts = [
        part if isinstance(part, Dual) else Dual(part)
        for part in terms(named(parameters), named(inputs))
    ]
    if any(abs(part.value) > mpf(10) ** 400 for part in parts):
        raise Beyond("a term is infinite")
    return parts


def stribeck(v: Dual, speed: Dual, exponent: Any) -> Dual:
    """exp(-|v/vs|^alpha)."""
    return exp(-power(magnitude(v / speed), exponent))


def rising(x: Dual) -> Dual:
    """1 - exp(-|x|), in the form that keeps its digits: the difference is exact at 50 digits
    only down to |x| = 1e-30."""
    if abs(x.value) > mpf(10) ** -20:
        return 1 - exp(-magnitude(x))
    y = magnitude(x)
    return y * (1 - y * (1 - y / 3) / 2)


# Laws of velocity: review, table 1.


@law
def coulomb(p: Any, x: Any) -> list[Dual]:
    return [p.a1 * x.v, p.a2 * sign(x.v)]


@law
def bittencourt_a(p: Any, x: Any) -> list[Dual]:
    s = sign(x.v)
    return [p.a1 * s, p.a2 * stribeck(x.v, p.a3, p.a4) * s, p.a5 * x.v]


@law
def clochiatti(p: Any, x: Any) -> list[Dual]:
    """Motoring while v tm > 0, driven back while v tm < 0, viscous alone while it is 0."""
    smooth = tanh(x.v / x.smoothing_velocity)
    power_flow = sign(x.v) * sign(x.tm)
    dry = {1: p.a2 * smooth, -1: p.a3 * smooth, 0: Dual(0)}[int(power_flow)]
    return [p.a1 * x.v, dry]


@law
def dong(p: Any, x: Any) -> list[Dual]:
    s = sign(x.v)
    return [
        p.a1 * x.v,
        p.a2 * s * _one_minus_exp(p.a3 * magnitude(x.v)),
        p.a4 * s * exp(-p.a5 * magnitude(x.v)),
    ]


def _one_minus_exp(x: Dual) -> Dual:
    """1 - exp(-x) of either sign."""
    if abs(x.value) > mpf(10) ** -20:
        return 1 - exp(-x)
    return x * (1 - x * (1 - x / 3) / 2)


@law
def gaz_a(p: Any, x: Any) -> list[Dual]:
    """1/(1 + exp(-y)) = (1 + tanh(y/2))/2: a constant torque and a smoothed sign."""
    half = p.a3 / 2
    return [p.a1 * x.v, p.a2, half, half * tanh(p.a4 * (x.v + p.a5) / 2)]


@law
def gaz_b(p: Any, x: Any) -> list[Dual]:
    """a1 (sigmoid(a2 (v + a3)) - sigmoid(a2 a3)) as one term.

    Two sigmoids apart hide that the torque vanishes with v, and the size would forgive its loss.
    With w = a2 a3, s(u + w) - s(w) = (1 - exp(-u)) s(u + w) s(-w).
    """
    u, w = p.a2 * x.v, p.a2 * p.a3
    if u.value > 0:
        return [p.a1 * _one_minus_exp(u) * sigmoid(u + w) * sigmoid(-w)]
    return [-p.a1 * _one_minus_exp(-u) * sigmoid(-(u + w)) * sigmoid(w)]


def _gaz_b_printed(p: Any, x: Any) -> list[Dual]:
    return [p.a1 * sigmoid(p.a2 * (x.v + p.a3)), -p.a1 * sigmoid(p.a2 * p.a3)]


PRINTED["gaz_b"] = _gaz_b_printed


@law
def grotjahn_a(p: Any, x: Any) -> list[Dual]:
    return [p.a1 * x.v, p.a2 * sign(x.v), p.a3 * cbrt(x.v)]


@law
def grotjahn_b(p: Any, x: Any) -> list[Dual]:
    return [p.a1 * x.v, p.a2 * sign(x.v), p.a3 * atan(p.a4 * x.v)]


@law
def hao_a(p: Any, x: Any) -> list[Dual]:
    s = sign(x.v)
    return [p.a1 * s, p.a2 * x.v, p.a3 * x.v * x.v * s, p.a4 * x.v * x.v * x.v]


@law
def indri_a(p: Any, x: Any) -> list[Dual]:
    s0 = atan(p.a6 * x.v) * (2 / mp.pi)
    return [p.a1 * s0, p.a2 * atan(p.a3 * x.v), p.a4 * x.v, p.a5 * x.v * x.v * s0]


@law
def makkar(p: Any, x: Any) -> list[Dual]:
    return [
        p.a1 * tanh(p.a2 * x.v),
        -p.a1 * tanh(p.a3 * x.v),
        p.a4 * tanh(p.a5 * x.v),
        p.a6 * x.v,
    ]


@law
def shao(p: Any, x: Any) -> list[Dual]:
    return [p.a1 * x.v, p.a2 * atan(p.a3 * x.v) * (2 / mp.pi)]


@law
def wolf(p: Any, x: Any) -> list[Dual]:
    s, e = sign(x.v), stribeck(x.v, p.a3, p.a4)
    return [s * p.a1, s * p.a2 * e, -s * p.a1 * e, s * p.a5 * power(magnitude(x.v), p.a6)]


@law
def zhou(p: Any, x: Any) -> list[Dual]:
    s, y = sign(x.v), power(magnitude(x.v / p.a4), p.a5)
    return [s * p.a1 * power(magnitude(x.v), p.a2), s * p.a3 * rising(y), s * p.a6 * exp(-y)]


# Laws with temperature and load: review, table 2.


@law
def bittencourt_b(p: Any, x: Any) -> list[Dual]:
    """Load enters as |tl|, and a12 > 0 thins the lubricant: both lost in the review's print."""
    s, load = sign(x.v), magnitude(x.tl)
    by_load = stribeck(x.v, p.a4, p.a5)
    by_heat = stribeck(x.v, p.a8 + p.a9 * x.T, p.a5)
    return [
        s * p.a1,
        s * p.a2 * load,
        s * p.a3 * load * by_load,
        s * p.a6 * by_heat,
        s * p.a7 * x.T * by_heat,
        p.a10 * x.v,
        p.a11 * exp(-x.T / p.a12) * x.v,
    ]


def _each(terms: list[Dual], factor: Dual) -> list[Dual]:
    return [term * factor for term in terms]


@law
def hao_b(p: Any, x: Any) -> list[Dual]:
    return [*hao_a(p, x), *_each(hao_a(p, x), p.a5 * (x.T - x.base_temperature))]


@law
def iskandar(p: Any, x: Any) -> list[Dual]:
    def quadratic(a: Dual, b: Dual, c: Dual) -> Dual:
        return a + b * x.T + c * x.T * x.T

    s = sign(x.v)
    dry = quadratic(p.a2, p.a3, p.a4)
    e = stribeck(x.v, quadratic(p.a5, p.a6, p.a7), 2)
    viscous = quadratic(p.a8, p.a9, p.a10)
    return [
        s * dry,
        s * p.a1 * e,
        -s * dry * e,
        s * viscous * power(magnitude(x.v), quadratic(p.a11, p.a12, p.a13)),
    ]


@law
def li(p: Any, x: Any) -> list[Dual]:
    s, speed = sign(x.v), magnitude(x.v)
    root = sqrt(speed)
    third = 1 / (x.T * x.T * x.T)
    return [
        p.a1,
        s * p.a2,
        s * p.a3 * power(speed, p.a4),
        s * root * p.a5,
        s * root * p.a6 * x.T,
        s * root * p.a7 * third,
        s * p.a8 * x.tl * x.tl,
    ]


@law
def madsen(p: Any, x: Any) -> list[Dual]:
    s, speed = sign(x.v), magnitude(x.v)
    root, warm = sqrt(speed), x.T - x.base_temperature
    return [
        s * p.a1 * exp(-power(speed / p.a2, p.a3)),
        s * root * p.a4 * warm,
        s * root * p.a5 / (warm * warm * warm),
        p.a6 * x.v,
        p.a7 * speed * x.v,
        p.a8 * x.v * x.v * x.v,
    ]


@law
def nevmerzhitskiy(p: Any, x: Any) -> list[Dual]:
    s, root = sign(x.v), sqrt(magnitude(x.v))
    return [
        s * p.a1,
        s * p.a2 * x.tl * x.tl,
        s * p.a3 * root,
        s * p.a4 * exp(-p.a5 * x.T) * root,
    ]


@law
def simoni(p: Any, x: Any) -> list[Dual]:
    warm = p.a6 * (x.T - x.base_temperature)
    return [*_each(hao_a(p, x), p.a5), *_each(hao_a(p, x), warm)]


# Static laws of the other papers.


@law
def gantry_map(p: Any, x: Any) -> list[Dual]:
    """Ball screw: eq 2, the viscous coefficient of table 1 by direction."""
    s, e = sign(x.v), stribeck(x.v, p.vs, 2)
    viscous = p.s2_plus if s > 0 else p.s2_minus
    return [s * p.Fc, s * p.Fs * e, -s * p.Fc * e, viscous * x.v]


@law
def indri_static(p: Any, x: Any) -> list[Dual]:
    """Direct-drive arm: eqs 3, 6, 7, one set of parameters per direction."""
    s, side = sign(x.v), "plus" if x.v > 0 else "minus"
    c0, c1, c2, c3, c4, w1, w2 = (
        getattr(p, f"{name}_{side}") for name in ("c0", "c1", "c2", "c3", "c4", "w1", "w2")
    )
    speed = magnitude(x.v)
    return [
        s * c0,
        s * c1 * exp(-speed / w1),
        s * c2 * _one_minus_exp(speed / w2),
        c3 * x.v,
        c4 * x.v * x.v,
    ]


@law
def m0(p: Any, x: Any) -> list[Dual]:
    s = sign(x.v)
    return [s * p.Fc, s * p.Fs * stribeck(x.v, p.vs, p.alpha), p.Fv * x.v]


@law
def m1(p: Any, x: Any) -> list[Dual]:
    s, load, e = sign(x.v), magnitude(x.tl), stribeck(x.v, p.vs, x.stribeck_exponent)
    return [
        s * p.Fc0,
        s * p.Fc_load * load,
        s * p.Fs0 * e,
        s * p.Fs_load * load * e,
        p.Fv * x.v,
    ]


@law
def m_star(p: Any, x: Any) -> list[Dual]:
    s, load = sign(x.v), magnitude(x.tl)
    by_load = stribeck(x.v, p.vs_load, x.stribeck_exponent)
    by_heat = stribeck(x.v, p.vs0 + p.vs_T * x.T, x.stribeck_exponent)
    return [
        s * p.Fc0,
        s * p.Fc_load * load,
        s * p.Fs_load * load * by_load,
        s * p.Fs0 * by_heat,
        s * p.Fs_T * x.T * by_heat,
        p.Fv0 * x.v,
        p.Fv_T * exp(-x.T / p.TV) * x.v,
    ]


@law
def karahan_karci(p: Any, x: Any) -> list[Dual]:
    """One set for each combination of the signs of v and a; steady motion counts as speeding up.

    The paper was not to be had: this is the review's description of it, section 2.1, with the
    usual Gaussian Stribeck curve.
    """
    s = sign(x.v)
    speeding = sign(x.a) or s
    side = {1: "p", -1: "m", 0: "p"}
    which = side[int(s)] + side[int(speeding)]
    fc, fs, fv, vs = (getattr(p, f"{name}_{which}") for name in ("Fc", "Fs", "Fv", "vs"))
    e = stribeck(x.v, vs, 2)
    return [s * fc, s * fs * e, -s * fc * e, fv * x.v]


# Servo laws: Duclusaud et al. 2024. te is the torque of the environment, tm the motor's.


def _servo(x: Any, kv: Dual, dry: Iterable[Dual]) -> list[Dual]:
    s = sign(x.v)
    return [*(s * part for part in dry), kv * x.v]


def _servo_stribeck(p: Any, x: Any) -> Dual:
    return stribeck(x.v, p.vs, p.alpha)


@law
def bam_m1(p: Any, x: Any) -> list[Dual]:
    return _servo(x, p.Kv, [p.Kc])


@law
def bam_m2(p: Any, x: Any) -> list[Dual]:
    return _servo(x, p.Kv, [p.Kc, _servo_stribeck(p, x) * p.Ks])


@law
def bam_m3(p: Any, x: Any) -> list[Dual]:
    return _servo(x, p.Kv, [p.Kc, p.Kl * magnitude(x.te - x.tm)])


@law
def bam_m4(p: Any, x: Any) -> list[Dual]:
    e, load = _servo_stribeck(p, x), magnitude(x.te - x.tm)
    return _servo(x, p.Kv, [p.Kc, e * p.Ks, p.Kl * load, e * p.Kls * load])


def _directional(p: Any, x: Any) -> list[Dual]:
    e = _servo_stribeck(p, x)
    return [
        p.Kc,
        e * p.Ks,
        magnitude(p.Ke * x.te - p.Km * x.tm),
        e * magnitude(p.Kes * x.te - p.Kms * x.tm),
    ]


@law
def bam_m5(p: Any, x: Any) -> list[Dual]:
    return _servo(x, p.Kv, _directional(p, x))


@law
def bam_m6(p: Any, x: Any) -> list[Dual]:
    e = _servo_stribeck(p, x)
    dry = _directional(p, x)
    if sign(x.te) * sign(x.tm) < 0:
        if abs(plain(x.te)) < abs(plain(x.tm)):
            dry.append(e * p.Kqe * x.te * x.te)
        elif abs(plain(x.te)) > abs(plain(x.tm)):
            dry.append(e * p.Kqm * x.tm * x.tm)
    return _servo(x, p.Kv, dry)

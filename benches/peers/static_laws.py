"""The static laws of the review of 25 models as a skilled user writes them with numpy, in place.

Each operation writes into memory that is kept: over an operand that nothing else reads, else into
the next free array. Operations on numbers alone happen once, and squares are products.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import stribeck as sb
from stribeck.models.published.sets import every_set
from timing import medians

SET = "ur5e_review/table_7/"
REPEATS = 9


class Memory:
    """Arrays for intermediate values."""

    def __init__(self, samples: int, arrays: int = 8) -> None:
        self.all = [np.zeros(samples) for _ in range(arrays)]
        self.free = list(self.all)

    def run(self, law: Law, p: Parameters, x: Mapping[str, np.ndarray]) -> np.ndarray:
        """The torque, in one of the arrays: valid until the next run."""
        self.free = list(self.all)
        return law(p, {name: Rows(array, self, kept=True) for name, array in x.items()}).array


class Rows:
    """One number per sample. An operation overwrites it unless it is kept."""

    def __init__(self, array: np.ndarray, memory: Memory, *, kept: bool = False) -> None:
        self.array, self.memory, self.kept = array, memory, kept

    def keep(self) -> Rows:
        """The same, for several readers."""
        self.kept = True
        return self

    def by(self, function: np.ufunc, *others: Rows | float, first: bool = True) -> Rows:
        """`function(self, *others)`, or `function(*others, self)`."""
        operands = (self, *others) if first else (*others, self)
        given = [x for x in operands if isinstance(x, Rows)]
        spare = [x.array for x in given if not x.kept]
        out = spare.pop(0) if spare else self.memory.free.pop()
        self.memory.free.extend(spare)
        function(*(x.array if isinstance(x, Rows) else x for x in operands), out=out)
        return Rows(out, self.memory)

    def __add__(self, other: Rows | float) -> Rows:
        return self.by(np.add, other)

    def __sub__(self, other: Rows | float) -> Rows:
        return self.by(np.subtract, other)

    def __rsub__(self, other: float) -> Rows:
        return self.by(np.subtract, other, first=False)

    def __mul__(self, other: Rows | float) -> Rows:
        return self.by(np.multiply, other)

    def __truediv__(self, other: Rows | float) -> Rows:
        if isinstance(other, Rows):
            return self.by(np.divide, other)
        return self.by(np.multiply, 1.0 / other)

    def __rtruediv__(self, other: float) -> Rows:
        return self.by(np.divide, other, first=False)

    def __pow__(self, power: Rows | float) -> Rows:
        return self.by(np.power, power)

    def __abs__(self) -> Rows:
        return self.by(np.abs)

    __radd__, __rmul__ = __add__, __mul__


#: Parameters by symbol, with the constants of the law.
Parameters = Mapping[str, float]
Law = Callable[[Parameters, dict[str, Rows]], Rows]
LAWS: dict[str, Law] = {}


def law(of: Law) -> Law:
    """Enter a law under the name of its function."""
    LAWS[of.__name__] = of
    return of


def curve(x: Rows, velocity: Rows | float, exponent: Rows | float) -> Rows:
    """exp(-|x/velocity|^exponent)."""
    return (abs(x / velocity) ** exponent * -1.0).by(np.exp)


def sigmoid(minus: Rows) -> Rows:
    """1 / (1 + exp(minus))."""
    return 1.0 / (minus.by(np.exp) + 1.0)


def sign(x: Rows) -> Rows:
    return x.by(np.sign)


@law
def coulomb(p: Parameters, x: dict[str, Rows]) -> Rows:
    return sign(x["v"]) * p["a2"] + x["v"] * p["a1"]


@law
def bittencourt_a(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    return (curve(v, p["a3"], p["a4"]) * p["a2"] + p["a1"]) * sign(v) + v * p["a5"]


@law
def clochiatti(p: Parameters, x: dict[str, Rows]) -> Rows:
    """Motoring where `v tm > 0`: half the sum and half the difference of both levels."""
    v, tm = x["v"], x["tm"]
    flow = sign(v * tm).keep()
    half, rest = 0.5 * (p["a2"] + p["a3"]), 0.5 * (p["a2"] - p["a3"])
    level = flow * flow * half + flow * rest
    return (v / p["smoothing_velocity"]).by(np.tanh) * level + v * p["a1"]


@law
def dong(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    speed = abs(v).keep()
    rise = (speed * -p["a3"]).by(np.exp) * -p["a2"] + p["a2"]
    return (rise + (speed * -p["a5"]).by(np.exp) * p["a4"]) * sign(v) + v * p["a1"]


@law
def gaz_a(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    return sigmoid((v + p["a5"]) * -p["a4"]) * p["a3"] + v * p["a1"] + p["a2"]


@law
def gaz_b(p: Parameters, x: dict[str, Rows]) -> Rows:
    level = p["a1"] / (1.0 + np.exp(-p["a2"] * p["a3"]))
    return sigmoid((x["v"] + p["a3"]) * -p["a2"]) * p["a1"] - level


@law
def grotjahn_a(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    return v.by(np.cbrt) * p["a3"] + sign(v) * p["a2"] + v * p["a1"]


@law
def grotjahn_b(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    return (v * p["a4"]).by(np.arctan) * p["a3"] + sign(v) * p["a2"] + v * p["a1"]


def cubic(p: Parameters, v: Rows) -> Rows:
    """a1 sgn v + a2 v + a3 |v| v + a4 v^3."""
    speed = abs(v).keep()
    return ((speed * p["a4"] + p["a3"]) * speed + p["a2"]) * v + sign(v) * p["a1"]


@law
def hao_a(p: Parameters, x: dict[str, Rows]) -> Rows:
    return cubic(p, x["v"])


@law
def indri_a(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    smooth = (v * p["a6"]).by(np.arctan) * (2.0 / np.pi)
    dry = smooth * (v * v * p["a5"] + p["a1"])
    return dry + (v * p["a3"]).by(np.arctan) * p["a2"] + v * p["a4"]


@law
def makkar(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    fall = (v * p["a2"]).by(np.tanh) - (v * p["a3"]).by(np.tanh)
    return fall * p["a1"] + (v * p["a5"]).by(np.tanh) * p["a4"] + v * p["a6"]


@law
def shao(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    return (v * p["a3"]).by(np.arctan) * (2.0 * p["a2"] / np.pi) + v * p["a1"]


@law
def wolf(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    dry = curve(v, p["a3"], p["a4"]) * (p["a2"] - p["a1"]) + p["a1"]
    return (dry + abs(v) ** p["a6"] * p["a5"]) * sign(v)


@law
def zhou(p: Parameters, x: dict[str, Rows]) -> Rows:
    v = x["v"]
    dry = curve(v, p["a4"], p["a5"]) * (p["a6"] - p["a3"]) + p["a3"]
    return (dry + abs(v) ** p["a2"] * p["a1"]) * sign(v)


@law
def bittencourt_b(p: Parameters, x: dict[str, Rows]) -> Rows:
    v, warm, load = x["v"], x["T"], abs(x["tl"]).keep()
    by_load = (curve(v, p["a4"], p["a5"]) * p["a3"] + p["a2"]) * load
    by_heat = curve(v, warm * p["a9"] + p["a8"], p["a5"]) * (warm * p["a7"] + p["a6"])
    viscous = (warm / -p["a12"]).by(np.exp) * p["a11"] + p["a10"]
    return (by_load + by_heat + p["a1"]) * sign(v) + viscous * v


@law
def hao_b(p: Parameters, x: dict[str, Rows]) -> Rows:
    factor = x["T"] * p["a5"] + (1.0 - p["a5"] * p["base_temperature"])
    return cubic(p, x["v"]) * factor


@law
def iskandar(p: Parameters, x: dict[str, Rows]) -> Rows:
    v, warm = x["v"], x["T"]
    dry, velocity, viscous, exponent = (
        (warm * c + b) * warm + a
        for a, b, c in ([p[f"a{k + i}"] for i in range(3)] for k in (2, 5, 8, 11))
    )
    dry.keep()
    ratio = (v / velocity).keep()
    fall = (ratio * ratio * -1.0).by(np.exp)
    return ((p["a1"] - dry) * fall + dry + abs(v) ** exponent * viscous) * sign(v)


@law
def li(p: Parameters, x: dict[str, Rows]) -> Rows:
    v, warm, load = x["v"], x["T"], x["tl"]
    speed = abs(v).keep()
    by_root = (p["a7"] / (warm * warm * warm) + warm * p["a6"] + p["a5"]) * speed.by(np.sqrt)
    dry = speed ** p["a4"] * p["a3"] + by_root + load * load * p["a8"] + p["a2"]
    return dry * sign(v) + p["a1"]


@law
def madsen(p: Parameters, x: dict[str, Rows]) -> Rows:
    v, warm = x["v"], (x["T"] - p["base_temperature"]).keep()
    speed = abs(v).keep()
    by_root = (p["a5"] / (warm * warm * warm) + warm * p["a4"]) * speed.by(np.sqrt)
    dry = (curve(speed, p["a2"], p["a3"]) * p["a1"] + by_root) * sign(v)
    return dry + ((speed * p["a8"] + p["a7"]) * speed + p["a6"]) * v


@law
def nevmerzhitskiy(p: Parameters, x: dict[str, Rows]) -> Rows:
    v, warm, load = x["v"], x["T"], x["tl"]
    by_root = ((warm * -p["a5"]).by(np.exp) * p["a4"] + p["a3"]) * abs(v).by(np.sqrt)
    return (load * load * p["a2"] + by_root + p["a1"]) * sign(v)


@law
def simoni(p: Parameters, x: dict[str, Rows]) -> Rows:
    factor = x["T"] * p["a6"] + (p["a5"] - p["a6"] * p["base_temperature"])
    return cubic(p, x["v"]) * factor


def inputs(velocity: np.ndarray) -> dict[str, np.ndarray]:
    """A motion with its temperature (degC), load and motor torque (N m), by channel."""
    turns = np.linspace(0.0, 40.0 * np.pi, velocity.size)
    load = 8.0 * np.cos(turns)
    return {
        "velocity": velocity,
        "temperature": 28.0 + 6.0 * np.sin(0.1 * turns),
        "load_torque": load,
        "motor_torque": load + 12.0 * np.sign(velocity),
    }


def compare_static_laws(velocity: np.ndarray) -> None:
    """Print the geometric mean over all laws as a row of the table, then each law."""
    channels = inputs(velocity)
    letters = {"velocity": "v", "temperature": "T", "load_torque": "tl", "motor_torque": "tm"}
    own, memory = np.empty_like(velocity), Memory(velocity.size)
    sets = {one.model.law: one.model for one in every_set().values() if one.id.startswith(SET)}
    ratios: dict[str, float] = {}
    for id, formula in LAWS.items():
        model = sets[id]
        read = {name: channels[name] for name in model.core.needs}
        symbols = [parameter.symbol for parameter in model.parameters]
        p = {**model.core.constants, **dict(zip(symbols, map(float, model.values), strict=True))}
        x = {letters[name]: array for name, array in read.items()}

        def ours(model: sb.Model = model, read: dict[str, np.ndarray] = read) -> None:
            model.torque(**read, out=own)

        def theirs(
            formula: Law = formula, p: Parameters = p, x: dict[str, np.ndarray] = x
        ) -> np.ndarray:
            return memory.run(formula, p, x)

        ours()
        size = np.abs(own).max()
        np.testing.assert_allclose(theirs(), own, rtol=1e-9, atol=1e-9 * size, err_msg=id)
        mine, other = medians(ours, theirs, REPEATS)
        ratios[id] = other / mine
    mean = np.exp(np.mean(np.log(list(ratios.values()))))
    samples = f"{velocity.size:.0e}".replace("e+0", "e")
    what = f"{len(ratios)} static laws, {samples} samples, geometric mean"
    print(f"| {what} | | numpy, in place | {mean:.2g} x |")
    print("  " + ", ".join(f"{id} {ratio:.2g}" for id, ratio in ratios.items()))

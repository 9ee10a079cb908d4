"""Numbers of 50 digits that carry their exact derivatives along (forward mode)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from mpmath import mp, mpf

mp.dps = 50

#: `exp` below this is 0: 10^-400000 is beyond any number a program holds.
UNDERFLOW = -(10**6)
#: `exp` above this is refused, instead of filling the memory with its exponent.
OVERFLOW = 10**6
#: Stands for infinity in 1/0 and 0^-1, so that exp(-1/0) = 0 and sgn(0)/0 = 0. What is left of
#: it in a result lies beyond any floating-point number, and is seen there.
HUGE = mpf(10) ** (10**7)


class Beyond(ArithmeticError):
    """The exact value is too large for any floating-point number."""


class Dual:
    """A value and its derivatives with respect to named quantities.

    Examples
    --------
    >>> x = variable("x", 3)
    >>> y = x * x + 1
    >>> int(y.value), int(y.slope["x"])
    (10, 6)
    """

    __slots__ = ("slope", "value")

    def __init__(self, value: Any, slope: Mapping[str, mpf] | None = None) -> None:
        self.value = mpf(value)
        self.slope = dict(slope or {})

    def _chain(self, value: mpf, slope: mpf) -> Dual:
        """A function of this number alone, by its value and its derivative here."""
        if slope == 0:
            return Dual(value)
        return Dual(value, {name: slope * d for name, d in self.slope.items()})

    def __add__(self, other: Number) -> Dual:
        if not isinstance(other, Dual):
            return Dual(self.value + other, self.slope)
        slope = dict(self.slope)
        for name, d in other.slope.items():
            slope[name] = slope[name] + d if name in slope else d
        return Dual(self.value + other.value, slope)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return self._chain(-self.value, mpf(-1))

    def __sub__(self, other: Number) -> Dual:
        return self + (-other)

    def __rsub__(self, other: Number) -> Dual:
        return other + (-self)

    def __mul__(self, other: Number) -> Dual:
        if not isinstance(other, Dual):
            return self._chain(self.value * other, mpf(other))
        left = self._chain(self.value * other.value, other.value)
        return left + other._chain(mpf(0), self.value)

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Dual:
        return self * (1 / other if not isinstance(other, Dual) else inverse(other))

    def __rtruediv__(self, other: Number) -> Dual:
        return inverse(self) * other

    def __gt__(self, other: Number) -> bool:
        return self.value > plain(other)

    def __lt__(self, other: Number) -> bool:
        return self.value < plain(other)


Number = Dual | mpf | int


def variable(name: str, value: Any) -> Dual:
    """A quantity to differentiate by."""
    return Dual(value, {name: mpf(1)})


def plain(x: Number) -> mpf:
    """The value without its derivatives."""
    return x.value if isinstance(x, Dual) else mpf(x)


def _function(of: Callable[[mpf], mpf], slope: Callable[[mpf, mpf], mpf]) -> Callable[[Dual], Dual]:
    def applied(x: Dual) -> Dual:
        value = of(x.value)
        return x._chain(value, slope(x.value, value))

    return applied


def _exp(x: mpf) -> mpf:
    if x > OVERFLOW:
        raise Beyond(f"exp({mp.nstr(x, 5)})")
    return mpf(0) if x < UNDERFLOW else mp.exp(x)


def _tanh(x: mpf) -> mpf:
    return mp.sign(x) if abs(x) > -UNDERFLOW else mp.tanh(x)


def _cosh_squared_inverse(x: mpf) -> mpf:
    """1 / cosh^2: 1 - tanh^2 would lose it beyond 50 digits."""
    e = _exp(-2 * abs(x))
    return 4 * e / (1 + e) ** 2


inverse = _function(lambda x: 1 / x if x else HUGE, lambda x, y: -y * y if x else mpf(0))
exp = _function(_exp, lambda x, y: y)
log = _function(mp.log, lambda x, y: 1 / x)
sqrt = _function(mp.sqrt, lambda x, y: 1 / (2 * y) if y else mpf(0))
atan = _function(mp.atan, lambda x, y: 1 / (1 + x * x))
tanh = _function(_tanh, lambda x, y: _cosh_squared_inverse(x))
sin = _function(mp.sin, lambda x, y: mp.cos(x))
magnitude = _function(abs, lambda x, y: mp.sign(x))
cbrt = _function(
    lambda x: mp.sign(x) * mp.cbrt(abs(x)), lambda x, y: 1 / (3 * y * y) if y else mpf(0)
)


def sigmoid(x: Dual) -> Dual:
    """1 / (1 + exp(-x))."""
    e = _exp(-abs(x.value))
    value = 1 / (1 + e) if x.value > 0 else e / (1 + e)
    return x._chain(value, e / (1 + e) ** 2)


def sign(x: Number) -> mpf:
    """-1, 0 or 1; a constant to the derivative."""
    return mp.sign(plain(x))


def power(base: Dual, exponent: Number) -> Dual:
    """base^exponent for base >= 0.

    At base = 0 the limit is taken (0, 1 or `HUGE`), and derivatives as 0: a law multiplies such
    terms by sgn(0).
    """
    p = exponent if isinstance(exponent, Dual) else Dual(exponent)
    if base.value == 0:
        return Dual(HUGE if p.value < 0 else int(p.value == 0))
    logarithm = mp.log(base.value)
    if p.value * logarithm > OVERFLOW:
        return Dual(HUGE)
    value = _exp(p.value * logarithm)
    return base._chain(value, p.value * value / base.value) + p._chain(mpf(0), value * logarithm)

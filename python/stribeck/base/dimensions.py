"""Units of a formula's parameters, derived from the units of its channels.

Every term of a friction law is a torque, and the argument of ``exp`` or ``tanh`` is a plain number:
in ``c2*tanh(v/c3)`` c3 must be a speed and c2 a torque. Each step of the formula's program is a
product of powers of torque, position, time and temperature; parameters bring unknown powers, and
the rules are linear equations for them. They are solved in fractions, so that an answer is exact or
there is none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from stribeck.base.units import CHANNEL_POWERS

#: What an operation of a formula works on: a number, the index of a parameter, a name, or nothing.
Detail = float | int | str | None
#: One operation of a formula's program: its name and its detail.
Operation = tuple[str, Detail]
#: Powers of torque, position, time and temperature.
Powers = tuple[Fraction, Fraction, Fraction, Fraction]


def powers(torque: int = 0, position: int = 0, time: int = 0, temperature: int = 0) -> Powers:
    """The powers of a unit."""
    return Fraction(torque), Fraction(position), Fraction(time), Fraction(temperature)


NUMBER = powers()
TORQUE = powers(torque=1)
CHANNELS: dict[str, Powers] = {name: powers(*unit) for name, unit in CHANNEL_POWERS.items()}
#: Functions that keep the unit, take a root of it, or compare two values of one unit.
_KEEPING = {"abs": Fraction(1), "sqrt": Fraction(1, 2), "cbrt": Fraction(1, 3)}
_COMPARING = {"min", "max"}


@dataclass(frozen=True)
class _Quantity:
    """A value's unit: known powers, times parameters to powers; None if it has no fixed unit."""

    known: Powers
    parameters: Mapping[int, Fraction] = field(default_factory=dict)
    number: float | None = None

    def times(self, other: _Quantity, power: Fraction = Fraction(1)) -> _Quantity:
        """The product with a power of another value."""
        known = tuple(a + power * b for a, b in zip(self.known, other.known, strict=True))
        parameters = dict(self.parameters)
        for index, exponent in other.parameters.items():
            parameters[index] = parameters.get(index, Fraction(0)) + power * exponent
        return _Quantity(known, {k: e for k, e in parameters.items() if e})  # type: ignore[arg-type]


def derive(operations: Sequence[Operation], count: int) -> tuple[Powers | None, ...]:
    """Powers of each of a formula's `count` parameters; None where the formula does not fix them.

    Parameters
    ----------
    operations
        The program of `_core.Formula`.

    Examples
    --------
    >>> from stribeck import _core
    >>> derive(_core.Formula("c*tanh(v/s)").operations, 2)[1] == CHANNELS["velocity"]
    True
    """
    rules = _Rules()
    rules.run(operations)
    return _solve(rules.equations, count) or (None,) * count


class _Rules:
    """Collects the equations of a program."""

    def __init__(self) -> None:
        self.equations: list[_Quantity] = []

    def run(self, operations: Sequence[Operation]) -> None:
        stack: list[_Quantity | None] = []
        for name, detail in operations:
            arguments = [stack.pop() for _ in range(_arity(name, detail))][::-1]
            stack.append(self._apply(name, detail, arguments))
        self._equal(stack.pop(), _Quantity(TORQUE))

    def _apply(
        self, name: str, detail: Detail, arguments: Sequence[_Quantity | None]
    ) -> _Quantity | None:
        if name == "constant" and isinstance(detail, float):
            return _Quantity(NUMBER, number=detail)
        if name == "parameter" and isinstance(detail, int):
            return _Quantity(NUMBER, {detail: Fraction(1)})
        if name == "channel" and isinstance(detail, str):
            return _Quantity(CHANNELS[detail])
        x = arguments[0]
        y = arguments[-1]
        if name in ("add", "subtract") or (name == "call" and detail in _COMPARING):
            self._equal(x, y)
            return y if x is None or x.number is not None else x
        if name == "negate":
            return x
        if name == "call" and detail == "pow":
            return self._power(x, y)
        if x is None or y is None:
            return _Quantity(NUMBER) if name == "call" and detail not in _KEEPING else None
        if name == "multiply":
            return x.times(y)
        if name == "divide":
            return x.times(y, Fraction(-1))
        if name == "integer_power" and isinstance(detail, int):
            return _Quantity(NUMBER).times(x, Fraction(detail))
        if isinstance(detail, str) and detail in _KEEPING:
            return _Quantity(NUMBER).times(x, _KEEPING[detail])
        if detail != "sgn":
            self._plain(x)
        return _Quantity(NUMBER)

    def _power(self, base: _Quantity | None, exponent: _Quantity | None) -> _Quantity | None:
        """A power that the formula does not fix leaves a unit only to what has none."""
        if exponent is not None and exponent.number is not None:
            if base is None:
                return None
            return _Quantity(NUMBER).times(base, Fraction(exponent.number).limit_denominator(1000))
        if exponent is not None:
            self._plain(exponent)
        if base is None or (not base.parameters and base.known != NUMBER):
            return None
        self._plain(base)
        return _Quantity(NUMBER)

    def _plain(self, x: _Quantity) -> None:
        """`x` must be a number; `exp(v)`, without a parameter, is left to the user."""
        if x.parameters:
            self.equations.append(x)

    def _equal(self, x: _Quantity | None, y: _Quantity | None) -> None:
        """Both have one unit; in `T - 25` the number has that of the channel."""
        if x is None or y is None:
            return
        for one, other in ((x, y), (y, x)):
            if one.number is not None and (one.number == 0.0 or not other.parameters):
                return
        self.equations.append(x.times(y, Fraction(-1)))


def _arity(name: str, detail: Detail) -> int:
    if name in ("constant", "parameter", "channel"):
        return 0
    if name in ("negate", "integer_power"):
        return 1
    return 2 if name != "call" or detail == "pow" or detail in _COMPARING else 1


def _solve(equations: Sequence[_Quantity], count: int) -> tuple[Powers | None, ...] | None:
    """Gauss and Jordan's elimination; None where the equations contradict each other."""
    rows = [
        ([e.parameters.get(k, Fraction(0)) for k in range(count)], [-x for x in e.known])
        for e in equations
    ]
    pivots: dict[int, int] = {}
    for column in range(count):
        top = len(pivots)
        found = next((r for r in range(top, len(rows)) if rows[r][0][column]), None)
        if found is None:
            continue
        rows[top], rows[found] = rows[found], rows[top]
        left, right = rows[top]
        lead = left[column]
        rows[top] = ([x / lead for x in left], [x / lead for x in right])
        for r, (other, side) in enumerate(rows):
            factor = other[column]
            if r != top and factor:
                rows[r] = (
                    [x - factor * p for x, p in zip(other, rows[top][0], strict=True)],
                    [x - factor * p for x, p in zip(side, rows[top][1], strict=True)],
                )
        pivots[column] = top
    if any(any(right) for left, right in rows if not any(left)):
        return None
    solved: list[Powers | None] = []
    for column in range(count):
        row = rows[pivots[column]] if column in pivots else None
        alone = row is not None and sum(map(bool, row[0])) == 1
        solved.append(tuple(row[1]) if row is not None and alone else None)  # type: ignore[arg-type]
    return tuple(solved)


def unit_text(unit: Powers, torque_unit: str, position_unit: str) -> str:
    """Spell a unit the way the catalog does: ``N m s/rad``, ``rad/s``, ``1/K``, ``1``.

    Examples
    --------
    >>> unit_text(powers(torque=1, position=-2, time=2), "N m", "rad")
    'N m s2/rad2'
    """
    bases = list(zip((torque_unit, position_unit, "s", "K"), unit, strict=True))

    def factor(base: str, power: Fraction) -> str:
        if power == 1:
            return base
        base = f"({base})" if " " in base else base
        return f"{base}{power}" if power.denominator == 1 else f"{base}^({power})"

    above = " ".join(factor(base, power) for base, power in bases if power > 0)
    below = "".join(f"/{factor(base, -power)}" for base, power in bases if power < 0)
    return (above or "1") + below


def natural_size(unit: Powers, scales: Mapping[str, float]) -> float:
    """The typical size of a quantity of this unit on a recording.

    It follows from the largest speed, the torque, the stroke and the span of temperature
    (`Recording.scales`). A time is a stroke over a speed.
    """
    torque, position, time, temperature = (float(power) for power in unit)
    speed = scales["speed"] or 1.0
    stroke = scales["position"] or 1.0
    size = (scales["torque"] or 1.0) ** torque * (scales["temperature"] or 1.0) ** temperature
    return float(size * speed ** (-time) * stroke ** (position + time))

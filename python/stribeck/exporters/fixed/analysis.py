"""Range, format and error bound of every number of a program over an operating box.

Ranges follow from interval arithmetic, error bounds from the error that each operation adds and
passes on. Channels are taken as exact: the bound holds for the sample that the controller reads.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from stribeck.base.errors import SpecError, option
from stribeck.exporters.fixed.functions import FUNCTIONS, Function, Table, power, tabulate
from stribeck.exporters.program import Operation, Program

#: Cells of a table, by the bits of a number.
CELLS = {32: 2048, 16: 128}

#: Largest error bound that is accepted, as a share of the largest torque.
MOST_ERROR = 0.05

#: Operations that are evaluated in advance where both operands are constant over the box.
_EXACTLY: dict[str, Callable[[float, float], float]] = {
    "add": operator.add,
    "subtract": operator.sub,
    "multiply": operator.mul,
}

#: Ranges are widened by this share for the rounding of their own computation.
_WIDER = 1e-12


@dataclass(frozen=True)
class Number:
    """Range, format and error bound of one number of a program.

    Attributes
    ----------
    low, high
        Range over the box.
    digits
        Binary digits behind the point: the number is a multiple of ``2^-digits``.
    error
        Bound of the difference from exact arithmetic.
    table
        For a function, the table that it is read from.
    """

    low: float
    high: float
    digits: int = 0
    error: float = 0.0
    table: Table | None = None

    @property
    def step(self) -> float:
        """The smallest difference that the format represents."""
        return math.ldexp(1.0, -self.digits)

    @property
    def size(self) -> float:
        """The largest magnitude."""
        return max(abs(self.low), abs(self.high))

    @property
    def is_fixed(self) -> bool:
        """Whether the number is constant over the box."""
        return self.low == self.high


class Analysis:
    """Ranges, formats and errors of all numbers of a program.

    Parameters
    ----------
    values
        Values of the parameters.
    box
        Sides by channel, SI units and degC.
    bits
        Size of a number: 32 or 16.
    spec
        The model, as errors name it.

    Raises
    ------
    SpecError
        The error has no bound: the model has a memory, divides by a range that contains 0, or a
        choice depends on a rounded number.
    """

    def __init__(
        self,
        program: Program,
        values: Sequence[float],
        box: Mapping[str, tuple[float, float]],
        bits: int,
        spec: str,
    ) -> None:
        self.program, self.values, self.box = program, values, box
        self.bits, self.spec = bits, spec
        self.numbers: dict[int, Number] = {}
        if program.states:
            self._stop("it has a memory")
        self.torque = self._of(program.torque)
        if self.torque.error > MOST_ERROR * self.torque.size:
            self._stop(f"its error may be {self.torque.error:.3g}")

    def _stop(self, why: str) -> NoReturn:
        raise SpecError(
            f"{self.spec} cannot be exported in fixed point: {why}; export it with "
            f"{option('precision', 'f32')}"
        )

    def _digits(self, low: float, high: float) -> int:
        """The most digits that the range allows; one bit is the sign, one is spare."""
        size = max(abs(low), abs(high))
        return 0 if size == 0.0 else self.bits - 2 - math.ceil(math.log2(size) + 1e-9)

    def _rounded(self, low: float, high: float, error: float, most: int | None = None) -> Number:
        """A result that is rounded to its format, with an error of less than one step."""
        if not (math.isfinite(low) and math.isfinite(high)):
            self._stop("one of its numbers has no bound over the box")
        digits = self._digits(low - error, high + error)
        digits = digits if most is None else min(digits, most)
        return Number(low, high, digits, error + math.ldexp(1.0, -digits))

    def _of(self, node: int) -> Number:
        """The number of a node; where a choice is certain, only the chosen node is analysed."""
        if node not in self.numbers:
            self.numbers[node] = self._number(self.program.operations[node])
        return self.numbers[node]

    def _number(self, operation: Operation) -> Number:
        if operation.name == "choose":
            return self._chosen(*operation.operands)
        known = [self._of(own) for own in operation.operands]
        match operation.name:
            case "constant":
                return self._fixed(operation.value)
            case "parameter":
                return self._fixed(float(self.values[operation.index]))
            case "time_step":
                return self._fixed(0.0)
            case "channel":
                low, high = self.box[operation.channel]
                return Number(low, high, self._digits(low, high))
            case "add" | "subtract" | "multiply" | "divide" | "power":
                return self._binary(operation.name, *known)
            case "below" | "above" | "equal":
                return self._compared(operation.name, *known)
            case "and":
                return Number(min(k.low for k in known), min(k.high for k in known))
            case "or":
                return Number(max(k.low for k in known), max(k.high for k in known))
            case "not":
                return Number(1.0 - known[0].high, 1.0 - known[0].low)
            case "is_finite":
                return Number(1.0, 1.0)
            case "negate":
                x = known[0]
                return Number(-x.high, -x.low, x.digits, x.error)
            case "abs":
                return self._magnitude(known[0])
            case "sign":
                return self._sign(known[0])
        return self._function(operation.name, known[0])

    def _fixed(self, x: float) -> Number:
        if not math.isfinite(x):
            self._stop("it computes with an infinite number")
        digits = self._digits(x, x)
        return Number(x, x, digits, abs(round(math.ldexp(x, digits)) * 2.0**-digits - x))

    def _binary(self, name: str, x: Number, y: Number) -> Number:
        if name == "multiply" and 0.0 == x.size * y.size:
            return self._fixed(0.0)
        if x.is_fixed and y.is_fixed and name in _EXACTLY:
            return self._fixed(_EXACTLY[name](x.low, y.low))
        if name == "power":
            return self._power(x, y)
        if name in ("add", "subtract"):
            other = (y.low, y.high) if name == "add" else (-y.high, -y.low)
            error = x.error + y.error
            # A number with too many digits for the other one is rounded first.
            aligned = self.aligned(x, y)
            error += math.ldexp(1.0, -aligned) * sum(n.digits > aligned for n in (x, y))
            return self._rounded(*_wider(x.low + other[0], x.high + other[1]), error)
        if name == "multiply":
            error = x.size * y.error + y.size * x.error + x.error * y.error
            corners = [a * b for a in (x.low, x.high) for b in (y.low, y.high)]
            return self._rounded(*_wider(min(corners), max(corners)), error)
        least = min(abs(y.low), abs(y.high)) - y.error
        if y.low <= 0.0 <= y.high or least <= y.step:
            self._stop("it divides by a number that may be 0 in the box")
        corners = [a / b for a in (x.low, x.high) for b in (y.low, y.high)]
        low, high = _wider(min(corners), max(corners))
        error = (x.error + max(abs(low), abs(high)) * y.error) / least
        # A wide number has so many bits more than a number: the numerator is shifted by no more.
        return self._rounded(low, high, error, x.digits - y.digits + self.bits - 1)

    def aligned(self, x: Number, y: Number) -> int:
        """Digits behind the point in which two numbers are added."""
        return min(max(x.digits, y.digits), min(x.digits, y.digits) + self.bits - 2)

    def _compared(self, name: str, x: Number, y: Number) -> Number:
        before, behind = x.high < y.low, x.low > y.high
        if name == "equal":
            certain = (x.is_fixed and y.is_fixed and x.low == y.low, before or behind)
        elif name == "below":
            certain = (before, x.low >= y.high)
        else:
            certain = (behind, x.high <= y.low)
        if not any(certain) and (x.error or y.error):
            self._stop("one of its choices depends on a rounded number")
        return Number(float(certain[0]), float(not certain[1]))

    def _chosen(self, decides: int, chosen: int, other: int) -> Number:
        mask = self._of(decides)
        if mask.is_fixed:
            own = self._of(chosen if mask.low else other)
            return Number(own.low, own.high, own.digits, own.error)
        yes, no = self._of(chosen), self._of(other)
        error = max(yes.error, no.error)
        return self._rounded(min(yes.low, no.low), max(yes.high, no.high), error)

    def _magnitude(self, x: Number) -> Number:
        low = 0.0 if x.low <= 0.0 <= x.high else min(abs(x.low), abs(x.high))
        return Number(low, x.size, x.digits, x.error)

    def _sign(self, x: Number) -> Number:
        if x.error and x.low <= 0.0 <= x.high:
            self._stop("one of its choices depends on a rounded number")
        low, high = float(np.sign(x.low)), float(np.sign(x.high))
        return Number(low, high, self._digits(-1.0, 1.0))

    def _power(self, x: Number, p: Number) -> Number:
        if not p.is_fixed:
            self._stop("one of its exponents varies")
        if p.low == 2.0:
            square = self._binary("multiply", x, x)
            low = 0.0 if x.low <= 0.0 <= x.high else square.low
            return Number(low, square.high, square.digits, square.error)
        if p.low == 1.0:
            return Number(x.low, x.high, x.digits, x.error)
        if x.low < 0.0 or p.low <= 0.0:
            self._stop("it raises a number to a power that has no bound")
        return self._tabulated(power(p.low), x)

    def _function(self, name: str, x: Number) -> Number:
        if name not in FUNCTIONS:
            self._stop(f"it needs {name}, for which there is no table")
        if name == "ln" and x.low - x.error <= 0.0:
            self._stop("it takes the logarithm of a number that may be 0 in the box")
        return self._tabulated(FUNCTIONS[name], x)

    def _tabulated(self, function: Function, x: Number) -> Number:
        # An argument that rounding moved out of its range is clipped, which adds no error.
        low, high = (
            min(max(end, function.settled[0]), function.settled[1]) for end in (x.low, x.high)
        )
        table = tabulate(function, low, high, x.step, CELLS[self.bits])
        below, above = float(table.values.min()), float(table.values.max())
        passed_on = x.error * table.steepness
        clipped = [
            abs(float(function.value(np.array([outside]))[0] - function.value(np.array([end]))[0]))
            for outside, end in ((x.low, low), (x.high, high))
            if (outside < low) or (outside > high)
        ]
        error = table.deviation + passed_on + max(clipped, default=0.0)
        found = self._rounded(below, above, error)
        # The entries are rounded, and so is the interpolation between two of them.
        return Number(found.low, found.high, found.digits, found.error + 2.0 * found.step, table)


def _wider(low: float, high: float) -> tuple[float, float]:
    slack = _WIDER * max(abs(low), abs(high))
    return low - slack, high + slack

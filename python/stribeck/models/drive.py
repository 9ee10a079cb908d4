"""A friction model behind a DC motor that is driven by a voltage.

With the motor torque tm = tl + tf(te, tm, v) of the joint, load and armature included, the mean
voltage on the motor is

    u = (R / kt) tm + kt v

(resistive drop and back-EMF; kt is torque per current and voltage per speed at the joint, gear
included). While the drive is off no current flows: tm = 0, whatever voltage stands at the motor.
Such a row is predicted without its back-EMF, as the resistive drop (R / kt) tm that the model
wrongly gives it, against a target of zero: the same quantity, R times the error in the current,
that a row with the drive on contributes.

Kv and the back-EMF act alike while the drive is on, so those rows give kt, R and Kv only together
(exactly so where friction does not depend on the motor torque); rows with the drive off show Kv
alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stribeck import _core

if TYPE_CHECKING:
    from stribeck.models.rows import ParameterRow

Array = NDArray[np.float64]
#: A column of the recording, or what stands for one.
Columns = Any

ARMATURE = "armature_inertia"
TORQUE_CONSTANT = "torque_constant"
RESISTANCE = "resistance"
#: Constants of a model behind a drive that need not be identified.
KNOWN = (TORQUE_CONSTANT, RESISTANCE)

_ROWS: tuple[ParameterRow, ...] = (
    {
        "name": TORQUE_CONSTANT,
        "symbol": "kt",
        "unit": "T/A",
        "lower": 0.02,
        "upper": 50.0,
        "start": 0.5,
        "scale": "back_emf",
        "role": "nonlinear",
        "linear": False,
        "description": "Torque per current, and back-EMF per speed, at the joint.",
    },
    {
        "name": RESISTANCE,
        "symbol": "R",
        "unit": "ohm",
        "lower": 0.02,
        "upper": 50.0,
        "start": 1.0,
        "scale": "resistance",
        "role": "nonlinear",
        "linear": False,
        "description": "Resistance of the winding.",
    },
)


class VoltageDrive:
    """A friction model seen through the voltage on its motor, in the shape of the core's `Model`.

    Parameters
    ----------
    friction
        Friction and rigid body of the joint, the effect ``inertia`` among them: the armature's.
    known
        `KNOWN` constants that are given and therefore no parameters.

    Examples
    --------
    >>> drive = VoltageDrive(_core.Model("coulomb", ["inertia"]), {"torque_constant": 0.4})
    >>> [row["symbol"] for row in drive.parameters()]
    ['a1', 'a2', 'Ja', 'R']
    """

    def __init__(self, friction: _core.Model, known: Mapping[str, float]) -> None:
        self.friction = friction
        self._known = {name: known[name] for name in KNOWN if name in known}
        self._delayed = "delay" in friction.effects
        # The back-EMF is that of the speed which the model's delay shifts: a viscous friction of 1.
        self._speed = _core.Model("coulomb", ["delay"] if self._delayed else [])

    @property
    def law(self) -> str:
        """Id of the friction law."""
        return self.friction.law

    @property
    def has_state(self) -> bool:
        """Whether friction depends on what went before."""
        return self.friction.has_state

    @property
    def needs(self) -> list[str]:
        """Columns it reads."""
        return self.friction.needs

    @property
    def constants(self) -> dict[str, float]:
        """Constants of the friction model, and what is known of the motor."""
        return {**self.friction.constants, **self._known}

    def parameters(self) -> list[ParameterRow]:
        """Those of the friction model, then those of the motor that are not known."""
        rows = [_armature(row) for row in self.friction.parameters()]
        return rows + [row.copy() for row in _ROWS if row["name"] not in self._known]

    def torque(
        self, values: Array, *, enabled: Array | None = None, state: float = 0.0, **columns: Columns
    ) -> Array:
        """Voltage of every row [V], array [n]; where not `enabled`, without the back-EMF."""
        inner, constant, resistance = self._apart(values)
        motor = _with_load(self.friction.torque(inner, **_all(columns), state=state), columns)
        back_emf = self._speed.torque(self._speed_values(inner), **_motion(columns))
        return resistance / constant * motor + constant * _where(enabled, back_emf)

    def gradient(
        self, values: Array, *, wanted: Sequence[int] | None = None, enabled: Array | None = None,
        state: float = 0.0, **columns: Columns,
    ) -> tuple[Array, Array]:  # fmt: skip
        """Voltage of every row, and its derivatives by the `wanted` parameters, [n, k]."""
        inner, constant, resistance = self._apart(values)
        names = [row["name"] for row in self.parameters()]
        chosen = list(range(len(names))) if wanted is None else list(wanted)
        of_friction = [k for k in chosen if k < inner.size]
        torque, slopes = self.friction.gradient(
            inner, **_all(columns), state=state, wanted=of_friction
        )
        motor = _with_load(torque, columns)
        back_emf, by_delay = self._speed.gradient(self._speed_values(inner), **_motion(columns))
        speed = _where(enabled, back_emf)
        ratio = resistance / constant
        jacobian = np.empty((torque.size, len(chosen)))
        jacobian[:, [k < inner.size for k in chosen]] = ratio * slopes
        for column, k in enumerate(chosen):
            if names[k] == TORQUE_CONSTANT:
                jacobian[:, column] = speed - ratio / constant * motor
            elif names[k] == RESISTANCE:
                jacobian[:, column] = motor / constant
            elif names[k] == "delay":
                jacobian[:, column] += constant * _where(enabled, by_delay[:, -1])
        return ratio * motor + constant * speed, jacobian

    def _apart(self, values: Array) -> tuple[Array, float, float]:
        """Values of the friction model, torque constant and resistance."""
        given = np.asarray(values, dtype=np.float64)
        count = len(self.friction.parameters())
        rest = iter(given[count:])
        constant, resistance = (
            self._known[name] if name in self._known else float(next(rest)) for name in KNOWN
        )
        return np.ascontiguousarray(given[:count]), constant, resistance

    def _speed_values(self, inner: Array) -> Array:
        if not self._delayed:
            return np.array([1.0, 0.0])
        names = [row["name"] for row in self.friction.parameters()]
        return np.array([1.0, 0.0, inner[names.index("delay")]])


def _armature(row: ParameterRow) -> ParameterRow:
    """The inertia is that of the armature; other rows stay as they are."""
    if row["name"] != "inertia":
        return row
    return {
        **row,
        "name": ARMATURE,
        "symbol": "Ja",
        "lower": 0.0,
        "description": "Inertia of motor and gear as the joint feels it.",
    }


def _all(columns: Mapping[str, Columns]) -> dict[str, Columns]:
    """The columns of the friction model; a delay shifts the load too, which the voltage holds."""
    return {**columns, "shift_load": True}


def _with_load(torque: Array, columns: Mapping[str, Columns]) -> Array:
    load = columns.get("load_torque")
    return torque if load is None else torque + load


def _motion(columns: Mapping[str, Columns]) -> dict[str, Columns]:
    """The columns of which a speed is made."""
    motion = {name: columns[name] for name in ("dt", "velocity")}
    if "smooth" in columns:
        motion["smooth"] = {"velocity": columns["smooth"]["velocity"]}
        motion["shift_load"] = False
    return motion


def _where(enabled: Array | None, values: Array) -> Array:
    return values if enabled is None else np.where(enabled, values, 0.0)

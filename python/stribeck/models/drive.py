"""A friction model behind a DC motor that is driven by a voltage.

With the motor torque tm = tl + tf(te, tm, v) of the joint, load and armature included, the mean
voltage on the motor is

    u = (R / kt) tm + kt v

(resistive drop and back-EMF; kt is torque per current and voltage per speed at the joint, gear
included). While the drive is off no current flows: tm = 0, whatever the voltage on the motor. The
prediction of such a sample is the resistive drop (R / kt) tm of the modelled torque, without
back-EMF, and its target is zero. So its residual is R times the error of the current, as it is for
samples with the drive on.

Viscous friction Kv and the back-EMF have the same effect while the drive is on: kt, R and Kv are
then identifiable only in combination (exactly so where friction does not depend on the motor
torque). Samples with the drive off determine Kv alone.
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
#: A channel of the recording, or a flag of the core.
Columns = Any

ARMATURE = "armature_inertia"
TORQUE_CONSTANT = "torque_constant"
RESISTANCE = "resistance"
#: Constants of the motor that may be known before a fit.
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
    """The voltage on the motor of a joint with friction, with the interface of the core's `Model`.

    Parameters
    ----------
    friction
        Friction and rigid body of the joint with the effect ``inertia``, which is the armature's.
    known
        Constants of the motor that are known, and therefore not parameters.

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
        # The back-EMF follows the delayed speed: the torque of a viscous friction of 1.
        self._speed = _core.Model("coulomb", ["delay"] if self._delayed else [])

    @property
    def law(self) -> str:
        """Id of the friction law."""
        return self.friction.law

    @property
    def has_state(self) -> bool:
        """Whether friction depends on the past motion."""
        return self.friction.has_state

    @property
    def needs(self) -> list[str]:
        """Channels that it reads."""
        return self.friction.needs

    @property
    def constants(self) -> dict[str, float]:
        """Constants of the friction model, and known constants of the motor."""
        return {**self.friction.constants, **self._known}

    def parameters(self) -> list[ParameterRow]:
        """Parameters of the friction model, then unknown constants of the motor."""
        rows = [_armature(row) for row in self.friction.parameters()]
        return rows + [row.copy() for row in _ROWS if row["name"] not in self._known]

    def torque(
        self, values: Array, *, enabled: Array | None = None, state: float = 0.0, **columns: Columns
    ) -> Array:
        """Voltage of each sample in V, array [n]; without back-EMF where not `enabled`."""
        inner, constant, resistance = self._apart(values)
        motor = _with_load(self.friction.torque(inner, **_all(columns), state=state), columns)
        back_emf = self._speed.torque(self._speed_values(inner), **_motion(columns))
        return resistance / constant * motor + constant * _where(enabled, back_emf)

    def gradient(
        self,
        values: Array,
        *,
        wanted: Sequence[int] | None = None,
        enabled: Array | None = None,
        state: float = 0.0,
        **columns: Columns,
    ) -> tuple[Array, Array]:
        """Voltage of each sample, array [n], and derivatives by `wanted` parameters, [n, k]."""
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
    """The row of the inertia as that of the armature; other rows unchanged."""
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
    """The channels of the friction model; a delay also shifts the load, part of the voltage."""
    return {**columns, "shift_load": True}


def _with_load(torque: Array, columns: Mapping[str, Columns]) -> Array:
    load = columns.get("load_torque")
    return torque if load is None else torque + load


def _motion(columns: Mapping[str, Columns]) -> dict[str, Columns]:
    """The channels of the speed."""
    motion = {name: columns[name] for name in ("dt", "velocity")}
    if "smooth" in columns:
        motion["smooth"] = {"velocity": columns["smooth"]["velocity"]}
        motion["shift_load"] = False
    return motion


def _where(enabled: Array | None, values: Array) -> Array:
    return values if enabled is None else np.where(enabled, values, 0.0)

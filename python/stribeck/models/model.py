"""A friction model: a law, the effects added to it, and the values of its parameters.

The mathematics lives in the compiled core; this module gives it names, units and values.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.models.catalog import check_effect, effect_ids, law_ids, law_row
from stribeck.models.channels import columns, split_columns
from stribeck.models.drive import ARMATURE, KNOWN, VoltageDrive
from stribeck.models.formula_law import FormulaTerms, check_names, effect_terms, is_formula
from stribeck.models.parameter import Parameter
from stribeck.models.writer import write_model

if TYPE_CHECKING:
    import os

Array = NDArray[np.float64]

#: Effects that belong to the rigid body when it is identified together with the friction.
RIGID_BODY_EFFECTS = ("inertia", "gravity")


@dataclass(frozen=True)
class Model:
    """A friction law with effects, and the values of its parameters.

    Parameters
    ----------
    law, effects
        Ids of the catalog. `effects` are kept in catalog order.
    constants
        Fixed numbers that belong to the model and are not fitted: reference temperature,
        the stroke of a position dependence ...
    rigid_body
        Rigid-body terms (``"inertia"``, ``"gravity"``) that were identified together with the
        friction; their parameters are part of `values`.
    values
        One value a parameter, NaN where none is known yet.
    drive
        ``"voltage"``: a fit predicts the voltage on the joint's motor, whose constants are
        parameters too; what is known of them stands in `constants`. `core`, `torque`, `gradient`
        and `split` speak of the friction alone, and so does `friction`, the model without a drive.
    own
        Terms by formula. Where the first has the name of `law`, it is the law; the others are
        effects.
    limits
        Bounds that were said, by parameter; they win over those of the catalog, and equal ones
        hold a parameter. `bounds` are those of the last fit.

    Examples
    --------
    >>> import stribeck as sb
    >>> m = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> m.torque([-1.0, 0.0, 1.0])
    array([-2.5,  0. ,  2.5])
    """

    law: str
    effects: tuple[str, ...] = ()
    constants: Mapping[str, float] = field(default_factory=dict)
    rigid_body: tuple[str, ...] = ()
    values: Array = field(default_factory=lambda: np.empty(0))
    torque_unit: str = "N m"
    position_unit: str = "rad"
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    box: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    drive: str | None = None
    own: tuple[FormulaTerms, ...] = ()
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.own:
            check_names(self.names, self.spec)
        if self.values.shape != (len(self.names),):
            object.__setattr__(self, "values", np.full(len(self.names), np.nan))

    @cached_property
    def core(self) -> _core.Model:
        """The compiled model."""
        for term in self.rigid_body:
            if term in self.effects:
                raise SpecError(
                    f"{term} is identified with the friction already (the recording has no "
                    f"load_torque), so effect {term!r} cannot be added"
                )
        return self._compiled(self.effects + self.rigid_body)

    @cached_property
    def predictor(self) -> _core.Model | VoltageDrive:
        """What predicts the measured effort: the compiled model, or the drive around it."""
        if self.drive is None:
            return self.core
        if "inertia" in self.effects:
            raise SpecError(
                f"the drive has an {ARMATURE} already, so effect 'inertia' cannot be added"
            )
        return VoltageDrive(
            self._compiled((*self.effects, *self.rigid_body, "inertia")), self.constants
        )

    def _compiled(self, effects: tuple[str, ...]) -> _core.Model:
        constants = {name: x for name, x in self.constants.items() if name not in KNOWN}
        try:
            law = None if self.by_formula else self.law
            own = [(terms.text, terms.names) for terms in self.own]
            return _core.Model(law, list(effects), constants, own)
        except _core.ModelError as error:
            raise SpecError(str(error)) from None

    @property
    def friction(self) -> Model:
        """The friction alone, without a drive, in N m or N."""
        if self.drive is None:
            return self
        constants = {name: x for name, x in self.constants.items() if name not in KNOWN}
        return replace(
            self, constants=constants, drive=None, torque_unit=self.load_unit,
            values=self._friction_values,
        )  # fmt: skip

    @property
    def load_unit(self) -> str:
        """Unit of loads and friction: the effort's, unless a drive stands between."""
        if self.drive is None:
            return self.torque_unit
        return "N m" if self.position_unit == "rad" else "N"

    @property
    def by_formula(self) -> bool:
        """Whether the law itself is a formula."""
        return bool(self.own) and self.own[0].name == self.law

    def formula(self, name: str) -> FormulaTerms | None:
        """The terms by formula of this name, if there are any."""
        return next((terms for terms in self.own if terms.name == name), None)

    def written(self, effect: str) -> str:
        """What adds this effect to another model: its id, or ``"NAME = FORMULA"``."""
        own = self.formula(effect)
        return effect if own is None else f"{own.name} = {own.text}"

    @property
    def own_effects(self) -> tuple[str, ...]:
        """Names of the effects by formula."""
        return tuple(terms.name for terms in self.own if terms.effect)

    @property
    def spec(self) -> str:
        """``law+effect+...``, as commands take it; formulas go by their names."""
        return "+".join((self.law, *self.own_effects, *self.effects))

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters in the order of `values`."""
        formulas = {name: terms for terms in self.own for name in terms.names}
        made = (
            Parameter.of(row, self.load_unit, self.position_unit)
            for row in self.predictor.parameters()
        )
        return tuple(
            self._with_statements(p, formulas[p.name]) if p.name in formulas else p for p in made
        )

    def _with_statements(self, parameter: Parameter, terms: FormulaTerms) -> Parameter:
        """A formula's parameter with what the formula and its user state about it."""
        k = terms.names.index(parameter.name)
        stated = terms.declarations[k]
        return replace(
            parameter,
            unit=terms.units(self.load_unit, self.position_unit)[k],
            lower=stated.lower,
            upper=stated.upper,
            start=math.nan if stated.start is None else stated.start,
            dimension=terms.dimensions[k],
        )

    @property
    def names(self) -> tuple[str, ...]:
        """Parameter names in the order of `values`."""
        return tuple(p.name for p in self.parameters)

    @property
    def has_state(self) -> bool:
        """Whether the torque depends on the past motion."""
        return bool(self.core.has_state)

    @property
    def memoryless(self) -> bool:
        """Whether each sample's torque depends on that sample alone."""
        return not self.has_state and "delay" not in self.effects

    def has(self, effect: str) -> bool:
        """Whether the law contains this effect, or it was added."""
        row = law_row(self.law)
        return effect in self.effects or (row is not None and effect in row["captures"])

    def value(self, name: str) -> float:
        """The value of one parameter, by name."""
        return float(self.values[self.names.index(name)])

    def with_values(self, values: ArrayLike) -> Model:
        """The same model with other values."""
        # A copy keeps what has been compiled for the model.
        made = copy(self)
        object.__setattr__(made, "values", np.asarray(values, dtype=np.float64).copy())
        made.__post_init__()
        return made

    def with_effect(self, effect: str, constants: Mapping[str, float]) -> Model:
        """The model with one more effect; values known before are kept, new ones are NaN.

        Parameters
        ----------
        effect
            An id of the catalog, or an effect by formula: ``"creep = c*abs(load)*sgn(v)"``.
        """
        if is_formula(effect):
            return self.with_terms(effect_terms(effect))
        check_effect(effect)
        if effect in self.effects:
            raise SpecError(f"effect {effect!r} is in {self.spec} already")
        effects = tuple(sorted((*self.effects, effect), key=effect_ids().index))
        return self._keeping_values(
            replace(
                self, effects=effects, constants={**self.constants, **constants}, values=np.empty(0)
            )
        )

    def with_terms(self, terms: FormulaTerms) -> Model:
        """The model with an effect by formula; values known before are kept, new ones are NaN."""
        if terms.name in (*law_ids(), *effect_ids()):
            raise SpecError(
                f"{terms.name!r} is in the catalog already: give the effect another name"
            )
        if terms.name in (self.law, *self.own_effects):
            raise SpecError(f"effect {terms.name!r} is in {self.spec} already")
        return self._keeping_values(replace(self, own=(*self.own, terms), values=np.empty(0)))

    def without_effect(self, effect: str) -> Model:
        """The model with one effect fewer."""
        effects = tuple(e for e in self.effects if e != effect)
        own = tuple(terms for terms in self.own if not (terms.effect and terms.name == effect))
        return self._keeping_values(replace(self, effects=effects, own=own, values=np.empty(0)))

    def _keeping_values(self, other: Model) -> Model:
        """`other` with the values of the parameters that it shares."""
        known = dict(zip(self.names, self.values, strict=True))
        return other.with_values([known.get(name, np.nan) for name in other.names])

    def torque(
        self,
        velocity: ArrayLike,
        position: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        load_torque: ArrayLike | None = None,
        motor_torque: ArrayLike | None = None,
        dt: ArrayLike | None = None,
        state: float | ArrayLike = 0.0,
        *,
        external_torque: ArrayLike | None = None,
        time: ArrayLike | None = None,
        load_torque_curvature: ArrayLike | None = None,
        precision: Literal["double", "single"] = "double",
    ) -> Array:
        """Friction torque of each sample, and identified rigid-body terms where there are any.

        Parameters
        ----------
        velocity : array [n]
            rad/s or m/s. The other channels likewise, SI units and degC; an effect that needs
            one of them raises when it is missing.
        dt : float or array [n]
            Step to the previous sample in s, for models with a state: sample i is the torque at
            the end of a step with velocity[i] held.
        state : float or array [state_size]
            State at the start: the deflection of a bristle in rad or m; of gms and leuven the
            force of each element, of bliman_sorine the fast and the slow force, in N m or N. The
            default is a joint without tension.
        external_torque : array [n]
            What the environment exerts on the joint, for the servo laws; default: minus the load
            torque, which is right where nothing accelerates.
        time : array [n]
            Since the start of the recording, s, for `drift`.
        load_torque_curvature : array [n]
            Second derivative of the load torque by time, N m/s2 or N/s2, for `elasticity`.
        precision
            ``"single"`` gives the bits of a controller that computes in 32 bits.

        Returns
        -------
        array [n]
        """
        given = {
            "position": position,
            "acceleration": acceleration,
            "temperature": temperature,
            "load_torque": load_torque,
            "motor_torque": motor_torque,
            "external_torque": external_torque,
            "time": time,
            "load_torque_curvature": load_torque_curvature,
        }
        return self.core.torque(
            self.known_values(),
            **columns(self.core, velocity, dt, given),
            state=state,
            single=precision == "single",
        )

    def gradient(
        self,
        velocity: ArrayLike,
        position: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        load_torque: ArrayLike | None = None,
        motor_torque: ArrayLike | None = None,
        dt: ArrayLike | None = None,
        state: float | ArrayLike = 0.0,
        *,
        external_torque: ArrayLike | None = None,
        time: ArrayLike | None = None,
        load_torque_curvature: ArrayLike | None = None,
    ) -> Array:
        """Derivative of `torque` with respect to the parameters, array [n, p]."""
        given = {
            "position": position,
            "acceleration": acceleration,
            "temperature": temperature,
            "load_torque": load_torque,
            "motor_torque": motor_torque,
            "external_torque": external_torque,
            "time": time,
            "load_torque_curvature": load_torque_curvature,
        }
        _, jacobian = self.core.gradient(
            self.known_values(), **columns(self.core, velocity, dt, given), state=state
        )
        return jacobian

    def split(self, velocity: ArrayLike, **channels: ArrayLike | None) -> dict[str, Array]:
        """The parts of the steady friction torque: ``dry`` (D), ``rate``, ``additive``.

        Parameters
        ----------
        velocity : array [n]
            rad/s or m/s.
        **channels : arrays [n]
            ``position``, ``acceleration``, ``temperature``, ``load_torque``, ``motor_torque``,
            ``external_torque``, ``time``, ``load_torque_curvature``. One that is left out stands
            at the middle of the operating box, time at that of the recording, the last one at 0.
        """
        found = split_columns(self.core, velocity, channels, self.box)
        return dict(self.core.split(self.known_values(), **found))

    def known_values(self) -> Array:
        """The values that `core` takes, array [p]; parameters of a drive are not among them.

        Raises
        ------
        SpecError
            A parameter has no value yet.
        """
        known = np.isfinite(self.values)
        if not known.all():
            unknown = [name for name, given in zip(self.names, known, strict=True) if not given]
            raise SpecError(f"{self.spec} has no value for {', '.join(unknown)}: fit it or give it")
        return self._friction_values

    @property
    def _friction_values(self) -> Array:
        if self.drive is None:
            return self.values
        own = {row["name"] for row in self.core.parameters()}
        return self.values[[name in own for name in self.names]]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model file (TOML).

        Raises
        ------
        ModelFileError
            A parameter has no value, or the path cannot be written.
        """
        write_model(self, path)

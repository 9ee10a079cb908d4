"""A friction model: a law, the effects added to it, and the values of its parameters.

The mathematics is in the compiled core; this module adds names, units and values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.arguments import door
from stribeck.base.errors import ModelFileError, SpecError, listed
from stribeck.base.shown import Shown
from stribeck.models import evaluate
from stribeck.models.catalog import check_effect, effect_ids, law_ids, law_row
from stribeck.models.channels import columns, constant, one_each, split_columns
from stribeck.models.compiled import compiled
from stribeck.models.drive import ARMATURE, KNOWN, VoltageDrive
from stribeck.models.fitted import Origin
from stribeck.models.formula_law import FormulaTerms, check_names, effect_terms, is_formula
from stribeck.models.parameter import Parameter, declared
from stribeck.models.stated import Stated
from stribeck.models.writer import write_model

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False, eq=False)
class Model(Shown):
    """A friction law with effects, and the values of its parameters.

    Parameters
    ----------
    law, effects
        Ids of the catalog. `effects` are kept in catalog order.
    constants
        Numbers that are not fitted: reference temperature, the stroke of a position dependence ...
    rigid_body
        Terms (``"inertia"``, ``"gravity"``) identified with the friction, with values in `values`.
    values
        Values of the parameters, array [p]; NaN where one is not known yet.
    torque_unit, position_unit
        Units of the predicted effort and of the position.
    bounds
        Bounds of the last fit, by parameter.
    box
        Operating box: (low, high) by channel, SI units and degC.
    drive
        ``"voltage"``: a fit predicts the voltage on the motor of the joint. The motor's constants
        are then parameters too; known ones are in `constants`. `core`, `torque`, `gradient` and
        `split` are those of the friction alone; `friction` is the model without the drive.
    own
        Terms by formula. The first is the law if it has the name of `law`; the others are effects.
    limits
        Bounds that are not the catalog's, by parameter; equal ones hold a parameter.
    stated
        What else a user stated about parameters.

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
    stated: Stated = field(default_factory=Stated)
    _origin: Origin = field(default_factory=Origin, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.own:
            check_names(self.names, self.spec)
        object.__setattr__(self, "values", constant(self.values, len(self.names)))

    def __getstate__(self) -> dict[str, object]:  # what is compiled is compiled again
        return {k: v for k, v in vars(self).items() if k not in ("core", "predictor")}

    @cached_property
    def core(self) -> _core.Model:
        """The compiled model."""
        for term in self.rigid_body:
            if term in self.effects:
                raise SpecError(
                    f"{term} is already identified with the friction (the recording has no "
                    f"load_torque), so effect {term!r} cannot be added"
                )
        return self._compiled(self.effects + self.rigid_body)

    @cached_property
    def predictor(self) -> _core.Model | VoltageDrive:
        """The predictor of the measured effort: the compiled model, or a drive with it inside."""
        if self.drive is None:
            return self.core
        if "inertia" in self.effects:
            raise SpecError(
                f"the drive already has an {ARMATURE}, so effect 'inertia' cannot be added"
            )
        return VoltageDrive(
            self._compiled((*self.effects, *self.rigid_body, "inertia")), self.constants
        )

    def _compiled(self, effects: tuple[str, ...]) -> _core.Model:
        return compiled(None if self.by_formula else self.law, effects, self.constants, self.own)

    @property
    def friction(self) -> Model:
        """The friction alone, without a drive, in N m or N."""
        if self.drive is None:
            return self
        constants = {name: x for name, x in self.constants.items() if name not in KNOWN}
        return replace(
            self,
            constants=constants,
            drive=None,
            torque_unit=self.load_unit,
            values=self._friction_values,
        )

    @property
    def load_unit(self) -> str:
        """Unit of loads and friction: that of the effort, unless the model has a drive."""
        if self.drive is None:
            return self.torque_unit
        return "N m" if self.position_unit == "rad" else "N"

    @property
    def by_formula(self) -> bool:
        """Whether the law itself is a formula."""
        return bool(self.own) and self.own[0].name == self.law

    def formula(self, name: str) -> FormulaTerms | None:
        """The terms by formula with this name; None where there are none."""
        return next((terms for terms in self.own if terms.name == name), None)

    def written(self, effect: str) -> str:
        """The text that adds this effect to a model: its id, or ``"NAME = FORMULA"``."""
        own = self.formula(effect)
        return effect if own is None else f"{own.name} = {own.text}"

    @property
    def own_effects(self) -> tuple[str, ...]:
        """Names of the effects by formula."""
        return tuple(terms.name for terms in self.own if terms.effect)

    @property
    def spec(self) -> str:
        """``law+effect+...``, with formulas by their names."""
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
            declared(p, formulas.get(p.name), self.load_unit, self.position_unit) for p in made
        )

    @cached_property
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

    @door()
    def value(self, name: str) -> float:
        """The value of one parameter, by name."""
        if name not in self.names:
            raise SpecError(f"{self.spec} has no parameter {name!r}: {', '.join(self.names)}")
        return float(self.values[self.names.index(name)])

    def with_values(self, values: ArrayLike) -> Model:
        """The same model with other values, array [p]; `SpecError` for another number of them."""
        made = object.__new__(Model)  # it shares what is compiled
        vars(made).update(vars(self), _origin=Origin(), values=one_each(self.names, values))
        made.__post_init__()
        return made

    @door()
    def with_effect(self, effect: str, constants: Mapping[str, float]) -> Model:
        """The model with one more effect; known values are kept, new ones are NaN.

        Parameters
        ----------
        effect
            An id of the catalog, or an effect by formula: ``"creep = c*abs(load)*sgn(v)"``.
        constants
            Constants that the effect needs, in SI units and degC.

        Raises
        ------
        SpecError
            The effect does not exist, or the model has it.
        """
        if is_formula(effect):
            return self.with_terms(effect_terms(effect))
        check_effect(effect)
        if effect in self.effects:
            raise SpecError(f"effect {effect!r} is already in {self.spec}")
        effects = tuple(sorted((*self.effects, effect), key=effect_ids().index))
        return self._keeping_values(
            replace(
                self, effects=effects, constants={**self.constants, **constants}, values=np.empty(0)
            )
        )

    def with_terms(self, terms: FormulaTerms) -> Model:
        """The model with an effect by formula; known values are kept, new ones are NaN."""
        if terms.name in (*law_ids(), *effect_ids()):
            raise SpecError(
                f"{terms.name!r} is already in the catalog: give the effect another name"
            )
        if terms.name in (self.law, *self.own_effects):
            raise SpecError(f"effect {terms.name!r} is already in {self.spec}")
        return self._keeping_values(replace(self, own=(*self.own, terms), values=np.empty(0)))

    def without_effect(self, effect: str) -> Model:
        """The model without one of its effects."""
        effects = tuple(e for e in self.effects if e != effect)
        own = tuple(terms for terms in self.own if not (terms.effect and terms.name == effect))
        return self._keeping_values(replace(self, effects=effects, own=own, values=np.empty(0)))

    def _keeping_values(self, other: Model) -> Model:
        """`other` with this model's values of the parameters that both have."""
        known = dict(zip(self.names, self.values, strict=True))
        return other.with_values([known.get(name, np.nan) for name in other.names])

    @door()
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
        temperature_rate: ArrayLike | None = None,
        precision: Literal["double", "single"] = "double",
        out: Array | None = None,
    ) -> Array:
        """Friction torque of each sample, and identified rigid-body terms where there are any.

        Parameters
        ----------
        velocity : array [n]
            rad/s or m/s. The other channels are in SI units and degC.
        dt : float or array [n]
            Time since the previous sample in s, for models with a state: sample i is the torque at
            the end of a step with velocity[i] held.
        state : float or array [state_size]
            State at the start: the deflection of a bristle in rad or m; for gms and leuven the
            force of each element, for bliman_sorine the fast and the slow force, in N m or N.
        external_torque : array [n]
            Of the environment on the joint, for the servo laws; default: minus the load torque.
        time : array [n]
            Time since the start of the recording in s, for `drift`.
        load_torque_curvature, temperature_rate : array [n]
            Second derivative of the load torque, behind a resonance of the spring's torque,
            N m/s2 or N/s2, for `elasticity`; first of the temperature, K/s, for `thermometer_lag`.
        precision
            ``"single"`` gives the bits of a controller that computes in 32 bits.
        out : array [n]
            float64, contiguous, none of the channels: receives the torque and is returned.

        Returns
        -------
        array [n], N m or N

        Raises
        ------
        SpecError
            A parameter has no value.
        ValueError
            A channel that the model reads is missing.
        """
        given = [position, acceleration, temperature, load_torque, motor_torque]
        given += [external_torque, time, load_torque_curvature, temperature_rate]
        read = columns(self.core, velocity, dt, given)
        return evaluate.torque(
            self.core, self.spec, self.known_values(), read, state, precision, out
        )

    @door()
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
        temperature_rate: ArrayLike | None = None,
        out: Array | None = None,
    ) -> Array:
        """Derivatives of `torque` with respect to the parameters; they and `out` are [n, p]."""
        given = [position, acceleration, temperature, load_torque, motor_torque]
        given += [external_torque, time, load_torque_curvature, temperature_rate]
        read = columns(self.core, velocity, dt, given)
        return evaluate.gradient(self.core, self.spec, self.known_values(), read, state, out)

    @door()
    def split(self, velocity: ArrayLike, **channels: ArrayLike | None) -> dict[str, Array]:
        """The parts of the steady friction torque: ``dry`` (D), ``rate``, ``additive``, arrays [n].

        Parameters
        ----------
        velocity : array [n]
            rad/s or m/s.
        **channels : arrays [n]
            ``position``, ``acceleration``, ``temperature``, ``load_torque``, ``motor_torque``,
            ``external_torque``, ``time``, ``load_torque_curvature``, ``temperature_rate``. Default:
            the middle of the box; for the time that of the recording, for the last two 0.
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
        if not np.isfinite(self.values).all():
            unknown = [self.names[k] for k in np.flatnonzero(~np.isfinite(self.values))]
            raise SpecError(
                f"{self.spec} has no value for {listed(unknown)}: fit the model or give values"
            )
        return self._friction_values

    @property
    def _friction_values(self) -> Array:
        if self.drive is None:
            return self.values
        own = [row["name"] for row in self.core.parameters()]
        return self.values[[name in own for name in self.names]]

    @door(ModelFileError)
    def save(self, path: str | PathLike[str]) -> None:
        """Write the model file (TOML), with the errors and provenance of its fit or file, if any.

        Raises
        ------
        ModelFileError
            A parameter has no value, or the path cannot be written.
        """
        known = self._origin
        write_model(self, path, known.stderr, known.fitted_on, known.per_run)

"""Models by name and by formula: what `stribeck.model` and `stribeck.law` return."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from stribeck.base.arguments import door
from stribeck.base.checks import check_finite
from stribeck.base.errors import SpecError, nearest
from stribeck.models.catalog import constants_of
from stribeck.models.formula_law import check_terms, law_terms
from stribeck.models.model import Model
from stribeck.models.signs import check_signs
from stribeck.models.spec import parse_spec


@door(spec=("a spec, LAW[+EFFECT...]", str))
def model(spec: str, /, *, constants: Mapping[str, float] | None = None, **values: float) -> Model:
    """A model by its spec, with parameter values by name or by symbol.

    Parameters
    ----------
    spec : str
        ``LAW[+EFFECT...]``, ids of the catalog.
    constants : dict of float
        Constants of the law and its effects, in SI units and degC.
    **values : float
        Values of parameters, in the parameters' units. Others are not known yet.

    Returns
    -------
    Model

    Raises
    ------
    SpecError
        A law, effect or parameter that does not exist, a constant that neither the law nor an
        effect reads, or a value that is not finite.

    Examples
    --------
    >>> model("bittencourt_a", a1=2.0, a2=1.0, a3=0.1, a4=2.0, a5=0.3).spec
    'bittencourt_a'
    """
    law, effects = parse_spec(spec)
    given = dict(constants or {})
    _check_constants(spec, law, effects, given)
    return with_values(Model(law=law, effects=effects, constants=given), values)


@door()
def law(formula: str, /, *effects: str, parameters: Iterable[str] = (), **values: float) -> Model:
    """A friction law by formula, to be fitted, compared and saved like those of the catalog.

    Parameters
    ----------
    formula : str
        Over the channels v, q, a, T, tl, tm, te (or velocity, position, acceleration, temperature,
        load, motor_torque, external_torque); every other name is a parameter. The text is only
        computed, never executed as code. ``"NAME = FORMULA"`` gives the law a name other than
        ``formula``.
    *effects : str
        Effects to add: ids of the catalog, or ``"NAME = FORMULA"``.
    parameters : iterable of str
        ``"c3: rad/s, 0.001..10, start 0.1"``: unit, bounds and start of a parameter, each of which
        may be left out. Without bounds a parameter is unbounded; unit and start then follow from
        the formula and the recording where they can.
    **values : float
        Values of parameters.

    Returns
    -------
    Model

    Raises
    ------
    SpecError
        The text is not a formula: what is wrong, and where.

    Examples
    --------
    >>> law("c1*v + c2*tanh(v/c3)*abs(load)", c1=0.5, c2=0.1, c3=1e-3).torque(1.0, load_torque=-4.0)
    array([0.9])
    """
    terms = law_terms(formula, parameters)
    check_terms(terms)
    made = Model(law=terms.name, own=(terms,))
    for effect in effects:
        made = made.with_effect(effect, {})
    return with_values(made, values)


def _check_constants(
    spec: str, law: str, effects: Iterable[str], constants: Mapping[str, float]
) -> None:
    read = constants_of(law, effects)
    for name in constants:
        if name not in read:
            known = f"it reads {', '.join(read)}" if read else "it reads none"
            if name in Model(law=law, effects=tuple(effects)).names:
                known = f"{name} is a parameter of it"
            raise SpecError(f"{spec} does not read the constant {name!r}; {known}")


def with_values(made: Model, values: Mapping[str, float]) -> Model:
    """The model with values by name or symbol.

    Parameters that are not given have none; those that the law holds have their usual one.
    """
    if not values:
        return made
    placed = dict.fromkeys(made.names, np.nan)
    usual = {p.name: p.start for p in made.parameters if p.role == "held"}
    symbols = {p.symbol: p.name for p in made.parameters}
    for given, value in values.items():
        name = given if given in placed else symbols.get(given)
        if name is None:
            raise SpecError(
                f"{made.spec} has no parameter {given!r}{nearest(given, (*placed, *symbols))}; "
                f"it has {', '.join(placed)}"
            )
        if np.isfinite(placed[name]):
            raise SpecError(f"parameter {name} of {made.spec} is given twice: omit {given}")
        placed[name] = check_finite(given, value)
    known = [usual.get(name, x) if np.isnan(x) else x for name, x in placed.items()]
    check_signs(made.law, made.parameters, known)
    return made.with_values(known)

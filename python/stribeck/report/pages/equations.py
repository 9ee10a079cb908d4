"""The equations of a model as MathML."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from stribeck.models.catalog import catalog
from stribeck.report.numbers import listed, plain
from stribeck.report.pages.mathml import mathml

if TYPE_CHECKING:
    from stribeck.models.model import Model

#: What an equation of an effect replaces, by the symbol that its formula begins with.
PARTS = {"D": "dry friction", "V": "viscous friction", "tf": "friction"}
#: Symbols that are no parameters.
SYMBOLS = {
    "v": "velocity",
    "q": "position",
    "a": "acceleration",
    "T": "temperature",
    "T0": "reference temperature",
    "tl": "load torque or force",
    "ts": "torque or force of the drive train's spring",
    "tm": "motor torque or force",
    "te": "external torque or force",
    "tf": "friction torque or force",
    "D": "dry friction",
    "V": "viscous friction",
    "z": "deflection of the bristle",
}
#: Constants are values of the recording: what each stands for in an equation.
CONSTANTS = {
    "tr": "reference load: the RMS of the load torque",
    "vr": "reference speed of the recording",
    "wn": "angular frequency of the resonance: infinite where the drive train has none",
    "zeta": "share of critical damping of the resonance",
    "tk": "torque at which the spring carries twice that of a linear one: infinite if it is linear",
    "Jm": "inertia of the motor: zero where all of the load torque oscillates",
    "xr": "reference torque: the 99th percentile of the motor torque",
}
#: Identified rigid-body terms, by their name in a model.
RIGID_BODY = {"inertia": "J a", "gravity": "gc cos q + gs sin q"}


@dataclass(frozen=True)
class Equation:
    """The equations of one part of a model.

    Attributes
    ----------
    name, title : str
        Id and title of the law or effect.
    text : str
        The formula in the notation of the catalog.
    statements : list of Markup
        MathML, one statement each.
    source : str
        Where the formula is printed; may be empty.
    """

    name: str
    title: str
    text: str
    statements: list[Markup]
    source: str = ""


def equations(model: Model) -> list[Equation]:
    """The law, its effects and the identified rigid body of a model."""
    rows = [] if model.formula(model.law) is not None else [_of_law(model.law)]
    rows += [
        Equation(
            own.name,
            "effect by formula" if own.effect else "law by formula",
            own.text,
            _set(own.text if own.effect else f"tf = {own.text}", own.effect),
        )
        for own in model.own
    ]
    rows += [_of_effect(name) for name in model.effects]
    if model.rigid_body:
        terms = f"tl = {' + '.join(RIGID_BODY[name] for name in model.rigid_body)}"
        rows.append(
            Equation("rigid body", "Load, identified with the friction", terms, _set(terms))
        )
    return rows


def symbols(model: Model) -> list[tuple[Markup, str]]:
    """The symbols of these equations that are no parameters, with their meaning."""
    used = " ".join(row.text for row in equations(model))
    words = set(re.findall(r"[A-Za-z]\w*", used)) | {"tf"}
    return [
        (Markup(mathml(name)[0]), meaning)
        for name, meaning in {**SYMBOLS, **CONSTANTS}.items()
        if name in words - {parameter.symbol for parameter in model.parameters}
    ]


def beside(model: Model) -> list[str]:
    """The sentences that equations need beside them."""
    changed = bool(model.effects) or any(own.effect for own in model.own)
    arrow = "An arrow replaces a part of the friction by what follows it." if changed else ""
    return [said for said in (arrow, absent_sentence(model), constants_sentence(model)) if said]


def absent_sentence(model: Model) -> str:
    """Which symbols in the equations of its effects a model does not have; empty: it has all."""
    own = {parameter.symbol for parameter in model.parameters}
    rows = (row for name in model.effects for row in catalog()["effects"][name]["parameters"])
    left = [str(row["symbol"]) for row in rows if row["symbol"] not in own]
    if not left:
        return ""
    return f"This model does not have {listed(left)}: the part of the equation with them is zero."


def constants_sentence(model: Model) -> str:
    """The constants in the equations; empty where there are none."""
    said = [f"{name} = {plain(value, 4)}" for name, value in model.constants.items()]
    return f"Constants, in SI units: {listed(said)}." if said else ""


def _of_law(law: str) -> Equation:
    row = catalog()["laws"][law]
    formula = str(row["formula"])
    first = formula.split(";")[0].split(",")[0]
    said = formula if "=" in first.replace("<=", "") else f"tf = {formula}"
    return Equation(law, str(row["title"]), said, _set(said), str(row["source"]))


def _of_effect(effect: str) -> Equation:
    row = catalog()["effects"][effect]
    formula = str(row["formula"])
    return Equation(effect, str(row["title"]), formula, _set(formula, changes=True))


def _set(formula: str, changes: bool = False) -> list[Markup]:
    """The statements as MathML; with what each replaces, where it changes a part."""
    made = []
    for k, statement in enumerate(mathml(formula)):
        lead = _changed(formula, k) if changes else ""
        text = statement
        if lead:
            symbol = mathml(lead)[0].removeprefix('<math displaystyle="true">')[:-7]
            text = statement.replace(
                '<math displaystyle="true">',
                f'<math displaystyle="true">{symbol}<mo>&#x2192;</mo>',
                1,
            )
        # The converter escapes whatever is not its own markup.
        made.append(Markup(text))
    return made


def _changed(formula: str, number: int) -> str:
    """What the statement of this number replaces; nothing for a definition."""
    statement = [part.strip() for part in formula.replace(";", ",").split(", ")]
    said = statement[number] if number < len(statement) else ""
    if number > 0 and said[:2] not in ("D ", "V "):
        return ""
    if "=" in said:
        return ""
    first = said.split(" ")[0].strip("(")
    return first if first in PARTS else "tf"

"""The header of an exported file: model, provenance, whether it is passive."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from stribeck.base.errors import SpecError
from stribeck.base.version import __version__
from stribeck.models.catalog import law_row
from stribeck.models.fitted import FittedOn
from stribeck.models.model import Model
from stribeck.passivity.certificate import Certificate
from stribeck.passivity.check import check
from stribeck.passivity.friction import friction_part

#: Torque of the terms of an identified rigid body, in the names of parameters and inputs.
_TERMS = {
    "inertia": "inertia * acceleration",
    "gravity": "gravity_cos * cos(position) + gravity_sin * sin(position)",
}
#: Their parameters.
_PARAMETERS = {"inertia": ("inertia",), "gravity": ("gravity_cos", "gravity_sin")}
#: What the load torque is where it was recorded.
LOAD = "the torque at the joint without its friction: gravity, inertia, contact"


@dataclass(frozen=True)
class About:
    """A model and its provenance.

    Attributes
    ----------
    fitted_on
        As in a model file; empty where unknown.
    certificate
        Whether the model is passive over its operating box; None where it cannot be checked.
    no_certificate
        Why it cannot be checked.
    """

    model: Model
    fitted_on: FittedOn = field(default_factory=FittedOn)
    certificate: Certificate | None = None
    no_certificate: str = ""

    @classmethod
    def of(
        cls,
        model: Model,
        fitted_on: FittedOn,
        box: Mapping[str, tuple[float, float]],
    ) -> About:
        """Describe a model; it is checked over its operating box, if it has one."""
        try:
            friction, _ = friction_part(model)
            sides = {name: side for name, side in box.items() if name in friction.core.needs}
            certificate = check(model, sides)
        except SpecError as error:
            return cls(model, fitted_on, None, str(error))
        return cls(model, fitted_on, certificate)

    @property
    def formula(self) -> str:
        """Formula of the law."""
        row = law_row(self.model.law)
        return str(row["formula"]) if row else self.model.own[0].text

    @property
    def title(self) -> str:
        """What was written, in one line."""
        return f"Friction model {self.model.spec}, written by stribeck {__version__}."

    def origin(self) -> Iterator[str]:
        """Lines of a comment on what was written, and what it was fitted to."""
        yield self.title
        yield from self._provenance()

    def lines(self) -> Iterator[str]:
        """Lines of a comment."""
        yield self.title
        yield ""
        yield f"Law: {self.formula}"
        row = law_row(self.model.law)
        if row:
            yield f"Source: {row['source']}"
        for terms in self.model.own_effects:
            yield f"Effect by formula: {self.model.written(terms)}"
        if self.model.effects:
            yield f"Effects: {', '.join(self.model.effects)}"
        if self.model.rigid_body:
            yield f"Rigid-body terms in the torque: {', '.join(self.model.rigid_body)}"
        yield from self._load()
        if "delay" in self.model.effects:
            yield "The delay is part of the recording, not of the joint: it is left out."
        constants = self.model.core.constants
        if constants:
            yield "Constants: " + ", ".join(f"{k} = {v:g}" for k, v in sorted(constants.items()))
        yield ""
        yield from self._provenance()
        yield from self._passivity()

    @property
    def rigid_body_torque(self) -> str | None:
        """The torque of the rigid body that was identified with the friction, as a formula."""
        terms = [_TERMS[name] for name in self.model.rigid_body]
        return " + ".join(terms) if terms else None

    @property
    def load_to_give(self) -> str | None:
        """How a controller computes the input ``load_torque``; None where there is none."""
        if "load_torque" not in self.model.core.needs:
            return None
        return self.rigid_body_torque or LOAD

    def _load(self) -> Iterator[str]:
        """What the torque holds besides friction, and how ``load_torque`` is computed."""
        formula, given = self.rigid_body_torque, self.load_to_give
        if formula is not None:
            yield "The torque of a step is friction plus the torque of the identified rigid body,"
            yield f"  {formula}."
            *first, last = [name for term in self.model.rigid_body for name in _PARAMETERS[term]]
            names = f"{', '.join(first)} and {last}" if first else last
            yield f"With 0 for {names} it is the friction alone."
        if given is not None and formula is not None:
            yield "The friction depends on that torque too: compute it, and give it as load_torque."
        elif given is not None:
            yield f"load_torque, an input, is {given}."

    def _provenance(self) -> Iterator[str]:
        fitted = self.fitted_on
        if not fitted:
            yield "Fitted to: unknown data."
            return
        yield f"Fitted to: {fitted.get('path', 'unknown data')}, {fitted.get('rows', '?')} samples"
        unit = self.model.torque_unit
        if "rmse_held_out" in fitted:
            held_out = f"held out {fitted['rmse_held_out']:.4g} {unit}"
            yield f"RMSE: {fitted['rmse']:.4g} {unit}, {held_out}"
        elif "rmse" in fitted:
            yield f"RMSE: {fitted['rmse']:.4g} {unit}"
        if "sha256" in fitted:
            yield f"SHA-256: {fitted['sha256']}"

    def _passivity(self) -> Iterator[str]:
        if self.certificate is None:
            yield f"Passive: unknown ({self.no_certificate})"
            return
        certificate = self.certificate
        words = {True: "yes, proved", False: "no, with a counterexample", None: "undecided"}
        sides = ", ".join(f"{k} {low:g} .. {high:g}" for k, (low, high) in certificate.box.items())
        yield f"Passive: {words[certificate.passive]} (condition: {certificate.condition})"
        yield f"Operating box: {sides}"

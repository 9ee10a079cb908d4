"""What an exported file says of itself: model, provenance, whether it is passive."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from stribeck.base.errors import SpecError
from stribeck.models.catalog import law_row
from stribeck.models.model import Model
from stribeck.passivity.certificate import Certificate
from stribeck.passivity.check import check


@dataclass(frozen=True)
class About:
    """A model and its provenance.

    Attributes
    ----------
    fitted_on
        As in a model file: ``path``, ``sha256``, ``rows``, ``rmse`` ...; empty where unknown.
    certificate
        Whether it is passive over its operating box; None where that cannot be asked.
    no_certificate
        Why there is none.
    """

    model: Model
    fitted_on: Mapping[str, Any] = field(default_factory=dict)
    certificate: Certificate | None = None
    no_certificate: str = ""

    @classmethod
    def of(
        cls,
        model: Model,
        fitted_on: Mapping[str, Any],
        box: Mapping[str, tuple[float, float]],
    ) -> About:
        """Check the model over its box, if it has one."""
        try:
            certificate = check(model, box)
        except SpecError as error:
            return cls(model, fitted_on, None, str(error))
        return cls(model, fitted_on, certificate)

    @property
    def formula(self) -> str:
        """What the law computes, in symbols."""
        row = law_row(self.model.law)
        return str(row["formula"]) if row else self.model.own[0].text

    def lines(self) -> Iterator[str]:
        """Plain sentences, for a comment."""
        from stribeck.base.version import __version__

        yield f"Friction model {self.model.spec}, written by stribeck {__version__}."
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
        if "delay" in self.model.effects:
            yield "The delay belongs to the recording, not to the joint: it is left out."
        constants = self.model.core.constants
        if constants:
            yield "Constants: " + ", ".join(f"{k} = {v:g}" for k, v in sorted(constants.items()))
        yield ""
        yield from self._provenance()
        yield from self._passivity()

    def _provenance(self) -> Iterator[str]:
        fitted = self.fitted_on
        if not fitted:
            yield "Fitted on: not said."
            return
        yield f"Fitted on: {fitted.get('path', 'not said')}, {fitted.get('rows', '?')} rows"
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
            yield f"Passive: not known ({self.no_certificate})"
            return
        certificate = self.certificate
        words = {True: "yes, proved", False: "no, there is a counterexample", None: "cannot decide"}
        sides = ", ".join(f"{k} {low:g} .. {high:g}" for k, (low, high) in certificate.box.items())
        yield f"Passive: {words[certificate.passive]} (condition: {certificate.condition})"
        yield f"Operating box: {sides}"

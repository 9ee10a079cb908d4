"""One model of a project, and its origin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from stribeck.base.errors import SpecError
from stribeck.models.formula_law import effect_terms, is_formula
from stribeck.projects.findings import Found, Remembered
from stribeck.projects.kept import Kept

#: How a node differs from its parent.
CHANGES = ("base", "add", "drop")


@dataclass(frozen=True)
class Node:
    """A fitted model: the base, or the model of its parent with one effect added or dropped.

    Attributes
    ----------
    number, parent
        The parent of the base is None.
    change : {"base", "add", "drop"}
    found
        The effect that was added or dropped, with its finding; None for the base.
    name
        Name of the branch that begins here; may be empty.
    rejected
        Effects that are not tested at this node and its descendants, with the reason, which may be
        empty.
    diagnosis
        Summary of the diagnosis, if there is one.
    """

    number: int
    parent: int | None
    change: str
    found: Found | None
    kept: Kept
    name: str = ""
    rejected: Mapping[str, str] = field(default_factory=dict)
    diagnosis: Remembered | None = None

    @property
    def effect(self) -> str | None:
        """The effect that was added or dropped."""
        return None if self.found is None else self.found.effect

    @property
    def label(self) -> str:
        """``coulomb``, ``+ load`` or ``- load``."""
        if self.found is None:
            return self.kept.model.spec
        return f"{'+' if self.change == 'add' else '-'} {self.found.effect}"

    def check_formula(self, effect: str) -> None:
        """Raise if an effect by formula has the name of this node's effect but another formula.

        Raises
        ------
        SpecError
            The formulas differ.
        """
        own = self.kept.model.formula(self.effect or "")
        if own is None or not is_formula(effect):
            return
        text = effect_terms(effect).text
        if text != own.text:
            raise SpecError(
                f"{own.name} = {own.text} was added here before (node {self.number}): give "
                f"{text!r} another name"
            )

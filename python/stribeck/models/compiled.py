"""A law and its effects, compiled by the core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.models.drive import KNOWN
from stribeck.models.formula_law import FormulaTerms


def compiled(
    law: str | None,
    effects: Sequence[str],
    constants: Mapping[str, float],
    formulas: Sequence[FormulaTerms],
) -> _core.Model:
    """The compiled model.

    Parameters
    ----------
    law
        Id of the catalog; None where the first of the `formulas` is the law.
    effects
        Ids of the catalog.
    constants
        Constants of the law and the effects; those of a motor are ignored.
    formulas
        Terms by formula.

    Raises
    ------
    SpecError
        The core has no such model.
    """
    own = [(terms.text, terms.names) for terms in formulas]
    known = {name: x for name, x in constants.items() if name not in KNOWN}
    try:
        return _core.Model(law, list(effects), known, own)
    except _core.ModelError as error:
        raise SpecError(str(error)) from None

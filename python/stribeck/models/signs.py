"""Signs that a paper prints in a parameter and a law carries in ``sgn v``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from stribeck.base.errors import SpecError
from stribeck.models.parameter import Parameter


class _Rule(NamedTuple):
    """Parameters of one printed quantity, where it has the sign of backward motion.

    The first decides the sign; the others change it together.
    """

    law: str
    names: tuple[str, ...]
    printed: str


_RULES = (
    _Rule(
        "tadese_full",
        ("viscous_level_backward", "viscous_level_slope_backward"),
        "eq 13 of Tadese et al. 2021 has sigma_2,n(T) < 0",
    ),
    _Rule(
        "tadese_full",
        ("coulomb_friction_backward",),
        "eqs 16 and 20 of Tadese et al. 2021 have F_c,n < 0",
    ),
)


def check_signs(law: str, parameters: Iterable[Parameter], values: Iterable[float]) -> None:
    """Refuse values with a printed sign that the law restores by itself.

    Raises
    ------
    SpecError
        With the rule, and the values to enter.
    """
    rules = [rule for rule in _RULES if rule.law == law]
    if not rules:
        return
    known = {p.name: (p.symbol, x) for p, x in zip(parameters, values, strict=True)}
    for rule in rules:
        symbol, value = known[rule.names[0]]
        if value < 0.0:
            turned = [known[name] for name in rule.names if known[name][1] == known[name][1]]
            entered = ", ".join(f"{own} = {-x:g}" for own, x in turned)
            raise SpecError(
                f"{law}: {rule.names[0]} ({symbol}) is {value:g}; {rule.printed}, and the law has "
                f"sgn v instead: turn the signs and enter {entered}"
            )

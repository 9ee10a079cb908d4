"""Parameter values printed in the papers, by law and symbol, from the installed sets."""

from __future__ import annotations

import stribeck as sb
from stribeck.models.catalog import catalog
from stribeck.models.published.sets import every_set, published_set


def printed(id: str) -> dict[str, float]:
    """The numbers of a set as its source prints them."""
    return {symbol: float(number) for symbol, number in published_set(id).printed.items()}


#: UR5e review 2024/25, table 7: every law fitted to joint 1, in the order of print.
TABLE_7 = {
    one.model.law: printed(one.id)
    for one in every_set().values()
    if one.id.startswith("ur5e_review/table_7/")
}
DYNAMIC_LAWS = {law: set for law, set in TABLE_7.items() if sb.model(law).has_state}
THERMAL_LAWS = {
    law: set
    for law, set in TABLE_7.items()
    if law not in DYNAMIC_LAWS
    and {"temperature", "load_torque"} & {*catalog()["laws"][law]["channels"]}
}
VELOCITY_LAWS = {
    law: set for law, set in TABLE_7.items() if law not in DYNAMIC_LAWS and law not in THERMAL_LAWS
}

#: Bittencourt et al. 2010: the speed-only model beside figure 10, and tables I and II.
M0 = printed("bittencourt/figure_10/m0")
M_STAR = printed("bittencourt/tables_1_2/m_star")

#: Valdiero group, table 1.
GANTRY = printed("gantry/table_1/gantry_map")


def direct_drive(joint: int) -> dict[str, float]:
    """Both directions of one joint of Indri et al., table 1."""
    return printed(f"indri/table_1/joint_{joint}/indri_static")

"""Whether other joints of the same file move: their links load this joint."""

from __future__ import annotations

import numpy as np
import polars as pl

from stribeck.base.errors import joint_called, listed
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View

__all__ = ["check_others"]

#: Another joint moves if its RMS motion is at least this share of this joint's.
_SHARE = 0.1


def check_others(view: View) -> Check | None:
    """Compare the motion of the joints of a file with several joints side by side.

    Returns
    -------
    Check or None
        None where no other joint moves, or the load torque of this joint was recorded. Nothing is
        contradicted: a joint of a moving robot can be read alone.
    """
    if view.recording.load_torque is not None:
        return None
    table = view.prepared.table
    for channel in ("velocity", "position"):
        for column in view.columns_of(channel):
            others = view.of_other_joints(column)
            if others:
                own = _size(table, column)
                moving = [j for j, name in others.items() if _size(table, name) > _SHARE * own]
                return _said(sorted(moving)) if moving else None
    return None


def _said(moving: list[str]) -> Check:
    several = len(moving) > 1
    which = f"joints {listed(moving)} move" if several else f"{joint_called(moving[0])} moves"
    what = "what they carry" if several else "what it carries"
    return Check(
        "others",
        True,
        f"{which} as well, and {what} loads this joint: `stribeck robot` identifies the "
        f"rigid bodies and the friction of all joints together",
    )


def _size(table: pl.DataFrame, column: str) -> float:
    """RMS of a column about its mean; 0 where it holds no numbers."""
    if not table.schema[column].is_numeric():
        return 0.0
    values = table[column].drop_nulls().to_numpy()
    return float(np.nanstd(values)) if values.size else 0.0

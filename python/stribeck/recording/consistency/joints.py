"""Whether the columns that are read belong to one joint, by their numbers."""

from __future__ import annotations

from collections import Counter

from stribeck.base.errors import option
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View
from stribeck.recording.naming.names import any_index, same_of_joint

__all__ = ["check_joints"]

_CHANNELS = ("position", "velocity", "acceleration", "torque")


def check_joints(view: View) -> Check | None:
    """Compare the joint numbers of the columns of a file with several joints side by side.

    Returns
    -------
    Check or None
        None where fewer than two columns carry a joint's number.
    """
    names = view.prepared.table.columns
    numbered = {
        column: index
        for channel in _CHANNELS
        for column in view.columns_of(channel)
        if (index := any_index(column)) is not None and same_of_joint(names, column)
    }
    stems = {column.rsplit(index, 1)[0] for column, index in numbered.items()}
    # Columns of one name, x1 and x2, are numbered by what they are and not by joints.
    if len(numbered) < 2 or len(stems) < len(numbered):
        return None
    (usual, _), *others = Counter(numbered.values()).most_common()
    if not others:
        return Check("joints", True, f"every column is of joint {usual}")
    odd = [column for column, index in numbered.items() if index != usual]
    listed = ", ".join(f"'{column}'" for column in numbered)
    return Check(
        "joints",
        False,
        f"the columns are of different joints: {listed}",
        f"read {' and '.join(odd)} from joint {usual}: {_maps(view, odd, usual)}",
    )


def _maps(view: View, odd: list[str], usual: str) -> str:
    """The options that read the columns of another joint."""
    given = []
    for channel in _CHANNELS:
        for column in view.columns_of(channel):
            if column in odd:
                right = same_of_joint(view.prepared.table.columns, column).get(usual)
                if right is not None:
                    given.append(view.replaced(channel, column, right))
    return " and ".join(given) or option("map", "CHANNEL=COLUMN")

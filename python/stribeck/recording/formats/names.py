"""Names of columns that a file does not name in full."""

from __future__ import annotations

from stribeck.base.units import find_unit
from stribeck.recording.naming.names import file_unit

__all__ = ["with_unit"]


def with_unit(name: str, unit: str | None) -> str:
    """The name of a column with its unit, if that is known and the name does not have it.

    Examples
    --------
    >>> with_unit("speed", "rpm"), with_unit("speed_rpm", "rpm"), with_unit("speed", "furlong")
    ('speed [rpm]', 'speed_rpm', 'speed')
    """
    text = (unit or "").strip()
    if not text or find_unit(text) is None or file_unit(name) is not None:
        return name
    return f"{name} [{text}]"

"""The versions that a result depends on, so that it can be repeated."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

from stribeck.base.version import __version__

#: Packages whose version can change a number or a figure.
PACKAGES = ("numpy", "scipy", "polars", "nlopt", "bokeh")


def versions() -> list[tuple[str, str]]:
    """Name and version of the package, of Python, of what it computes with, and the machine."""
    rows = [("stribeck", __version__), ("Python", platform.python_version())]
    for name in PACKAGES:
        try:
            rows.append((name, version(name)))
        except PackageNotFoundError:
            continue
    return [*rows, ("machine", f"{platform.system()} {platform.machine()}")]

"""The version of the package, as the compiled core states it."""

from stribeck._core import __version__

__all__ = ["__version__"]

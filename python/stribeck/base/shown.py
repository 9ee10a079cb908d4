"""Results that can be printed, plotted and shown in a notebook without knowing how.

A result class derives from `Shown`, or from `Plotted` where it has a figure. The functions that
render it are registered by name and loaded when a result is first shown, so that results never
import their renderers.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Where the renderers are: ``"module:function"`` by ``"module:class"`` and kind.
_RENDERERS: dict[tuple[str, str], str] = {}


def register(shown: str, **renderers: str) -> None:
    """Name the functions that render a class.

    Parameters
    ----------
    shown
        The class as ``"module:class"``; subclasses are rendered alike unless registered too.
    **renderers
        Functions by kind, each as ``"module:function"``: ``text`` returns a str, ``notebook`` HTML
        and ``figure`` a matplotlib figure.
    """
    for kind, function in renderers.items():
        _RENDERERS[shown, kind] = function


def registered() -> dict[tuple[str, str], str]:
    """All renderers: ``"module:function"`` by ``"module:class"`` and kind."""
    return dict(_RENDERERS)


class Shown:
    """A result whose text and notebook view are registered."""

    def __repr__(self) -> str:
        function = _registered(type(self), "text")
        return object.__repr__(self) if function is None else str(_load(function)(self))

    def summary(self) -> str:
        """The result as the command line prints it."""
        return repr(self)

    def _repr_html_(self) -> str:
        function = _registered(type(self), "notebook")
        if function is not None:
            return str(_load(function)(self))
        from html import escape

        return f"<pre>{escape(repr(self))}</pre>"


class Plotted(Shown):
    """A result that also has a figure."""

    def plot(self) -> Figure:
        """Draw the result as a matplotlib figure."""
        return draw(self)


def draw(result: object, kind: str = "figure", **options: object) -> Figure:
    """Draw a result by a figure that is registered for its class.

    Raises
    ------
    TypeError
        No such figure is registered.
    """
    function = _registered(type(result), kind)
    if function is None:
        raise TypeError(f"{type(result).__name__} has no {kind}")
    figure: Figure = _load(function)(result, **options)
    return figure


def _registered(shown: type, kind: str) -> str | None:
    """The renderer of a class or its nearest base as ``"module:function"``."""
    names = (f"{base.__module__}:{base.__qualname__}" for base in shown.__mro__)
    return next((_RENDERERS[name, kind] for name in names if (name, kind) in _RENDERERS), None)


def _load(function: str) -> Callable[..., Any]:
    module, _, name = function.partition(":")
    return getattr(importlib.import_module(module), name)

"""Every result finds its renderers, and showing one thing does not load what another needs."""

import importlib
import inspect
import subprocess
import sys

import pytest
import stribeck as sb
from stribeck.base.shown import Plotted, Shown, register
from stribeck.report import RENDERERS


@pytest.mark.parametrize("shown", RENDERERS)
def test_table_names_classes_and_functions_that_exist(shown: str) -> None:
    module, _, name = shown.partition(":")
    result = getattr(importlib.import_module(module), name)
    assert issubclass(result, Plotted if "figure" in RENDERERS[shown] else Shown)
    assert result.__repr__ is Shown.__repr__, "a dataclass needs repr=False to keep the mixin's"
    for renderer in RENDERERS[shown].values():
        module, _, name = renderer.partition(":")
        function = getattr(importlib.import_module(f"stribeck.report.{module}"), name)
        assert inspect.isfunction(function)


def test_subclass_is_rendered_as_its_base_until_it_has_its_own() -> None:
    class Base(Shown):
        pass

    class Derived(Base):
        pass

    module, base = Base.__module__, Base.__qualname__
    assert "Derived object at" in repr(Derived())
    register(f"{module}:{base}", text="builtins:id", notebook="builtins:hash")
    assert repr(Derived()).isdigit()
    register(f"{module}:{Derived.__qualname__}", text="builtins:callable")
    assert repr(Derived()) == "False"


def test_no_figure_is_a_clear_error() -> None:
    class Empty(Plotted):
        pass

    with pytest.raises(TypeError, match="Empty has no figure"):
        Empty().plot()


def test_text_loads_no_plotting_library() -> None:
    # In a new process: other tests have drawn figures by now.
    said = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys, stribeck.report.fit, stribeck as sb; sb.model('coulomb');"
            "print(sorted({'matplotlib', 'jinja2'} & set(sys.modules)))",
        ],
        check=True,
        capture_output=True,
        text=True,
    )
    assert said.stdout == "[]\n"


def test_notebook_shows_tables_and_text(improvement: sb.Improvement) -> None:
    assert "<table" in improvement.final._repr_html_()
    shown = improvement._repr_html_()
    assert shown.startswith("<pre>") and improvement.final.model.spec in shown

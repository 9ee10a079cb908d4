"""Every result finds its renderers, and showing one thing does not load what another needs."""

import importlib
import inspect
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb
from stribeck.base.shown import Plotted, Shown, register
from stribeck.diagnosis.inspect import inspect as inspect_files
from stribeck.report import RENDERERS
from stribeck.robot.diagnosis import RobotDiagnosis
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import RobotMotion


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


@pytest.mark.slow
def test_notebook_shows_tables_figures_and_text(
    improvement: sb.Improvement, diagnosis: sb.Diagnosis
) -> None:
    first = diagnosis.findings[0]
    compared = sb.compare([improvement.base, improvement.final], improvement.final.recording)
    views = [r._repr_html_() for r in (improvement.final, improvement, diagnosis, compared, first)]
    for shown in views:
        assert 'data-root-id="' in shown and "<pre>" in shown
        assert "made <&> odd" not in shown
    # A notebook is one page: the library is shown once.
    scripts = [part for shown in views for part in shown.split("<script")]
    assert sum(len(part) > 1_000_000 for part in scripts) <= 1
    assert all("<table" in shown for shown in views[:-1])
    assert "Velocity over time</figcaption>" in improvement.final.recording._repr_html_()


def test_every_result_has_a_view_for_notebooks() -> None:
    assert [shown for shown, renderers in RENDERERS.items() if "notebook" not in renderers] == []


@pytest.mark.slow
def test_views_that_are_tables(
    improvement: sb.Improvement, motion: RobotMotion, tmp_path: Path
) -> None:
    data = Path(improvement.final.recording.path)
    model = improvement.final.model
    found = improve_robot(motion, most_steps=0)
    shown = [
        (model, "equations"),
        (sb.check(model), "channel"),
        (inspect_files(data, joint_kind="revolute"), "cannot be tested"),
        (sb.Project.new(tmp_path / "p.toml", data, model, starts=1, joint_kind="revolute"), "node"),
        (found, "base parameters"),
        (found.final, "held out"),
        (RobotDiagnosis.of(found), "lacks"),
    ]
    for result, words in shown:
        view = result._repr_html_()
        assert "<table" in view and words in view and "Markup" not in view
        assert "<&>" not in view
    assert "<math" in model._repr_html_() and "load" in repr(model)
    exported = sb.export(model, "c", tmp_path / "c")
    assert "coulomb+load in c, f64" in exported._repr_html_()

"""The tutorials of the documentation, executed as notebooks."""

from __future__ import annotations

from pathlib import Path

import bokeh
import jupytext
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[3]
TUTORIALS = ROOT / "docs/tutorials"
DATA = ROOT.parent / "shared/data"
#: Tutorials that read published measurements.
WITH_DATA = ("emps", "whole_robot")


def executed(name: str) -> list[str]:
    """The HTML that the cells of a tutorial show."""
    notebook = jupytext.read(TUTORIALS / f"{name}.py")
    client = NotebookClient(notebook, timeout=600, kernel_name="python3")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STRIBECK_DATA", str(DATA))
        client.execute()
    outputs = [o for cell in notebook.cells for o in cell.get("outputs", ())]
    return [str(o["data"]["text/html"]) for o in outputs if "text/html" in o.get("data", {})]


def test_every_tutorial_is_run_below() -> None:
    names = {path.stem for path in TUTORIALS.glob("*.py")}
    assert names == {"the_loop", "log_to_controller", *WITH_DATA}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["the_loop", "log_to_controller"])
def test_a_tutorial_runs(name: str) -> None:
    shown = executed(name)
    assert sum("data-root-id" in html for html in shown) >= 1
    # The library is in the notebook once.
    library = Path(bokeh.__file__).parent / "server" / "static" / "js" / "bokeh.min.js"
    size = library.stat().st_size
    assert sum(len(html) > size for html in shown) == 1


@pytest.mark.slow
@pytest.mark.minutes
@pytest.mark.skipif(not DATA.is_dir(), reason="the public data sets are not at ../shared/data")
@pytest.mark.parametrize("name", WITH_DATA)
def test_a_tutorial_on_measurements_runs(name: str) -> None:
    """A cell that fails stops it; its assertions are about the published numbers."""
    executed(name)

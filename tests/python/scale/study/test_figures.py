"""Pictures of a study: units, every law named, nothing outside the frame."""

from __future__ import annotations

from pathlib import Path

import pytest
from stribeck.report.study_figure import error_figure, friction_figure
from stribeck.scale.study.result import Study
from stribeck.scale.study.study import study

from .conftest import LAWS


@pytest.fixture(scope="module")
def made(two_joints: Path, tmp_path_factory: pytest.TempPathFactory) -> Study:
    return study(two_joints, tmp_path_factory.mktemp("figures") / "out", LAWS, starts=1)


def test_box_plots_name_laws_units_and_speeds(made: Study) -> None:
    figure = error_figure(made, "near")
    whole, slow = figure.axes
    assert [label.get_text() for label in whole.get_yticklabels()] == [
        "bittencourt_a",
        "coulomb",
        "lugre",
    ]
    assert "[N m]" in whole.get_xlabel() and "measured" in whole.get_xlabel()
    assert "|v| < 0.10 rad/s" in slow.get_title(loc="left")
    entry = made.tables[0].rows[0].entries["near"]
    boxes = [p.get_path().get_extents() for p in whole.patches]
    assert boxes[0].x0 == pytest.approx(entry.whole.quartiles[0])
    assert boxes[0].x1 == pytest.approx(entry.whole.quartiles[2])


def test_friction_has_one_panel_a_law(made: Study) -> None:
    figure = friction_figure(made, "far")
    panels = [axes for axes in figure.axes if axes.get_visible()]
    assert [a.get_title(loc="left").split(":")[0] for a in panels] == [
        "bittencourt_a",
        "coulomb",
        "lugre",
    ]
    for axes in panels:
        measured, modelled = axes.get_lines()
        assert len(measured.get_xdata()) == len(modelled.get_xdata()) > 100
    assert "rad/s" in figure.get_supxlabel() and "[N m]" in figure.get_supylabel()


def test_pictures_of_every_joint_are_written(made: Study) -> None:
    names = {p.name for p in made.folder.glob("*.png")}
    assert names == {
        f"{kind}_{joint}.png" for kind in ("errors", "friction") for joint in ("near", "far")
    }

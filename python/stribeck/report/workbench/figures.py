"""The figures of each page of the workbench, and the samples that a zoom asks for."""

from __future__ import annotations

import base64
import itertools
import json
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from stribeck.report.finding_view import finding_view
from stribeck.report.interactive.channels_time import RecordingSamples, channels_time
from stribeck.report.interactive.falling_error import falling_error
from stribeck.report.interactive.finding_residual import evidence, evidence_columns
from stribeck.report.interactive.findings import findings
from stribeck.report.interactive.planned import planned
from stribeck.report.interactive.samples import Samples, samples_of
from stribeck.report.interactive.time import residual_time
from stribeck.report.pages.figures import parameter_plots, sample_plots
from stribeck.report.workbench.controller import Workbench

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.fitting.result import Fit
    from stribeck.projects.project import Project
    from stribeck.recording.recording import Recording
    from stribeck.report.workbench.state import Joint

#: Names by which the script of the pages finds the samples and the range of time.
SAMPLES, WINDOW = "samples", "window"


class Drawn:
    """The figures of the pages, each page's made once for what it shows."""

    def __init__(self, bench: Workbench) -> None:
        self._bench = bench
        self._samples: dict[str, Samples | RecordingSamples] = {}
        #: Of each page, what its figures are drawn of and their number.
        self._numbered: dict[str, tuple[Sequence[object], str]] = {}
        #: Of each page, the number of the figures that were made last, and them as JSON.
        self._made: dict[str, tuple[str, str]] = {}
        self._numbers = itertools.count(1)
        self._numbering, self._drawing = threading.Lock(), threading.Lock()

    def number(self, page: str) -> str:
        """The number of the figures of a page; empty if it has none."""
        with self._numbering:
            of = self._shown(page)
            if not of:
                return ""
            known = self._numbered.get(page)
            if known is None or not _same(known[0], of):
                known = self._numbered[page] = (of, str(next(self._numbers)))
            return known[1]

    def answer(self, page: str, shown: str = "") -> str:
        """The figures of a page as JSON of BokehJS, with their `number`.

        Parameters
        ----------
        shown
            The number of those that the page shows; if they are these, that is all that is said.
        """
        with self._drawing:
            number = self.number(page)
            if not number:
                return json.dumps({})
            if number == shown:
                return json.dumps({"same": True})
            known = self._made.get(page)
            if known is None or known[0] != number:
                text = json.dumps({"number": number, **as_json(self.plots(page))})
                known = self._made[page] = (number, text)
            return known[1]

    def _shown(self, page: str) -> Sequence[object]:
        """What the figures of a page are drawn of; empty: there are none."""
        joint = self._bench.state.current
        if joint is None:
            return ()
        if page == "data":
            return () if joint.recording is None else (joint.recording,)
        if page == "compare":
            return () if joint.sides is None else joint.sides.comparison.models
        if page == "prove":
            return () if joint.plan is None else (joint.plan,)
        project = joint.project
        if project is None:
            return ()
        if page == "where":
            return () if joint.comparison is None else (project.fit,)
        if page == "missing":
            return _findings_of(project)
        if page == "add":
            return (*project.tree.path(project.current), project.tree.noise_floor)
        return ()

    def plots(self, page: str) -> dict[str, figure]:
        """The figures of a page, by the names of their places."""
        joint = self._bench.state.current
        if joint is None:
            return {}
        if page == "data" and joint.recording is not None:
            return self._windowed(channels_time(self._channels(joint.recording)))
        if page == "where" and joint.project is not None and joint.comparison is not None:
            made = sample_plots(self._of(page, [joint.project.fit]))
            return self._windowed({**made, **parameter_plots(joint.project.fit)})
        if page == "compare" and joint.sides is not None:
            fits = [a.fit for a in joint.sides.comparison.models]
            return self._windowed(sample_plots(self._of(page, fits)))
        if page == "missing":
            return self._found(joint)
        if page == "prove" and joint.plan is not None:
            return planned(joint.plan)
        return _errors(joint) if page == "add" else {}

    def window(self, page: str, start: float, end: float) -> dict[str, dict[str, str]]:
        """The samples that are drawn between two times, as the script of the pages takes them."""
        joint = self._bench.state.current
        if joint is None or page not in self._samples:
            return {}
        samples = self._samples[page]
        return {
            name: {
                "type": values.dtype.name,
                "content": base64.b64encode(values.tobytes()).decode("ascii"),
            }
            for name, values in samples.data(*samples.within(start, end)).items()
        }

    def _found(self, joint: Joint) -> dict[str, figure]:
        """The findings with their evidence, and time, in which samples are selected."""
        diagnosis = None if joint.project is None else joint.project.diagnosis
        if diagnosis is None or not diagnosis.findings:
            return {}
        views = {
            f"finding {k}": finding_view(found.effect, found.before, found.fit)
            for k, found in enumerate(diagnosis.findings, 1)
        }
        samples = samples_of([diagnosis.fit])
        samples = samples.with_columns(evidence_columns(views, samples.rows))
        self._samples["missing"] = samples
        made = {"findings": findings(diagnosis.findings, diagnosis.noise_floor.value)}
        for (name, view), found in zip(views.items(), diagnosis.findings, strict=True):
            made[name] = evidence(found.effect, view, samples.unit, samples, name)
        if not diagnosis.fit.recording.averaged:
            made["time"] = residual_time(samples)
        return self._windowed(made)

    def _of(self, page: str, fits: list[Fit]) -> Samples:
        self._samples[page] = made = samples_of(fits)
        return made

    def _channels(self, recording: Recording) -> RecordingSamples:
        made = RecordingSamples.of(recording)
        self._samples["data"] = made
        return made

    def _windowed(self, plots: dict[str, figure]) -> dict[str, figure]:
        """Name what the script of the pages changes when the time axis is zoomed."""
        first = plots.get("time")
        if first is not None:
            first.x_range.name = WINDOW
            first.renderers[0].data_source.name = SAMPLES
        return plots


def as_json(plots: dict[str, figure]) -> dict[str, object]:
    """Figures as BokehJS embeds them: in one document, so that they share their samples."""
    from bokeh.embed.util import OutputDocumentFor, standalone_docs_json_and_render_items

    models = list(plots.values())
    if not models:
        return {}
    with OutputDocumentFor(models):
        docs, (item,) = standalone_docs_json_and_render_items(models)
        places = {name: plot.id for name, plot in plots.items()}
    return {"docs": docs, "item": item.to_json(), "places": places}


def _errors(joint: Joint) -> dict[str, figure]:
    """The error along the branch of the current model."""
    if joint.project is None:
        return {}
    path = joint.project.tree.path(joint.project.current)
    held_out = [node.kept.rmse_held_out for node in path]
    known = [error for error in held_out if error is not None]
    every = len(known) == len(path)
    return {
        "errors": falling_error(
            [node.label for node in path],
            known if every else [node.kept.rmse for node in path],
            joint.project.node.kept.model.torque_unit,
            noise_floor=joint.project.tree.noise_floor,
            held_out=every,
        )
    }


def _findings_of(project: Project) -> Sequence[object]:
    """What tells the findings of a project from others."""
    if project.diagnosis is None or not project.diagnosis.findings:
        return ()
    errors = [(f.effect, f.rmse_held_out_after) for f in project.diagnosis.findings]
    return (str(project.path), project.current, *itertools.chain(*errors))


def _same(some: Sequence[object], others: Sequence[object]) -> bool:
    """Whether these are the same objects, or words and numbers that are equal."""
    return len(some) == len(others) and all(
        a is b or (isinstance(a, str | int | float) and a == b)
        for a, b in zip(some, others, strict=True)
    )

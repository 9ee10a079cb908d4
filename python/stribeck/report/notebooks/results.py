"""What a notebook shows of a result: a sentence, its tables, figures to zoom and select in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

from markupsafe import Markup

from stribeck.base.shown import Plotted
from stribeck.report.fleet import heading
from stribeck.report.interactive.channels_time import RecordingSamples, channels_time
from stribeck.report.interactive.finding_residual import finding_residual
from stribeck.report.interactive.planned import planned
from stribeck.report.interactive.samples import CHANNELS
from stribeck.report.numbers import change_text, confidence_words, plain
from stribeck.report.pages.account import Account, of_comparison, of_diagnosis, of_improvement
from stribeck.report.pages.figures import NO_FIGURES, Figures, account_plots, figures_of
from stribeck.report.pages.fleet import fleet_plots
from stribeck.report.pages.recording import parameter_table, picture_text, render
from stribeck.report.recording import scored_sentence

if TYPE_CHECKING:
    import polars as pl
    from bokeh.plotting import figure

    from stribeck.diagnosis.compare import Comparison
    from stribeck.diagnosis.loop.add import Addition
    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.diagnosis.result import Diagnosis, Finding
    from stribeck.fitting.result import Fit
    from stribeck.motion.design.result import Plan
    from stribeck.projects.sides import Sides
    from stribeck.recording.recording import Recording
    from stribeck.scale.fleet.result import Fleet

#: Figures of a view, in their order, with what stands above each.
SHOWN = {
    "errors": "Error after each step",
    "findings": "Error with each effect added alone, best first",
    **{f"step {k}": f"Residual without and with effect {k}" for k in range(1, 10)},
    "time": "Torque over time: a drag selects samples in all figures",
    "residual": "Residual over time",
    "friction": "Friction against velocity",
    "loop position": "Friction loop over position",
    "loop reversal": "Friction after a reversal",
    **{f"against {name}": f"Residual against {name}" for name in CHANNELS if name != "time"},
    "intervals": "95 % intervals",
    "correlation": "Correlations of the parameters",
}
_loaded: list[bool] = []


class Tabular(Protocol):
    """A result that can be had as a table."""

    def to_frame(self) -> pl.DataFrame: ...


def fit_view(fit: Fit) -> str:
    """A fit: errors, parameters, friction, torque and intervals."""
    return _account_view(Account(_fit_sentence(fit), (fit,), fit), repr(fit))


def comparison_view(comparison: Comparison) -> str:
    """Models side by side: their errors, and figures of the best ones."""
    account = of_comparison(comparison)
    rows = [["model", f"RMSE [{comparison.recording.torque_unit}]", "held-out RMSE"]]
    rows += [
        [a.model, plain(a.rmse), "" if a.rmse_held_out is None else plain(a.rmse_held_out)]
        for a in comparison.models
    ]
    return _account_view(account, repr(comparison), [rows])


def sides_view(sides: Sides) -> str:
    """Two models of a project side by side."""
    return _account_view(of_comparison(sides.comparison), repr(sides))


def diagnosis_view(diagnosis: Diagnosis) -> str:
    """What is missing from a model: the findings with their evidence."""
    account = of_diagnosis(diagnosis)
    return _account_view(account, repr(diagnosis), _steps(account))


def improvement_view(improvement: Improvement) -> str:
    """The way from a base model to the final one: falling error, evidence, parameters."""
    account = of_improvement(improvement)
    return _account_view(account, repr(improvement), _steps(account))


def addition_view(addition: Addition) -> str:
    """An effect that was added: the residual before and after, and the new model."""
    fit = addition.after
    account = Account(_fit_sentence(fit), (addition.before, fit), fit)
    residual = finding_residual(addition.effect, addition.before, fit)
    return _account_view(account, repr(addition), [], {"step 1": residual})


def finding_view(finding: Finding) -> str:
    """One finding: where the data shows it."""
    plots = {finding.where: finding_residual(finding.effect, finding.before, finding.fit)}
    said = f"{finding.effect}: {confidence_words(finding.confidence)}"
    return view(said, text=repr(finding), figures=figures(plots))


def picture_view(result: Plotted) -> str:
    """Any other result with a figure: the figure, and all in words."""
    picture = picture_text(result.plot())
    return view(type(result).__name__, text=repr(result), picture=picture)


def recording_view(recording: Recording) -> str:
    """What was measured, over time."""
    plots = channels_time(RecordingSamples.of(recording))
    names = {name: "torque" if name == "time" else name for name in plots}
    shown = {f"{names[name].capitalize()} over time": plots[name] for name in plots}
    return view(scored_sentence(recording), text=repr(recording), figures=figures(shown))


def plan_view(plan: Plan) -> str:
    """A planned motion over time, and what it shows."""
    plots = {
        f"{name.capitalize()} over time; limits dashed": p for name, p in planned(plan).items()
    }
    return view("Planned motion", text=repr(plan), figures=figures(plots))


def fleet_view(fleet: Fleet) -> str:
    """Which joints of a fleet changed, and which have an effect that their peers lack."""
    return view(heading(fleet), text=repr(fleet), figures=figures(fleet_plots(fleet)))


def frame_view(result: Tabular) -> str:
    """A result that is a table: the table, and all in words."""
    frame = result.to_frame()
    rows = [frame.columns, *([cell(value) for value in row] for row in frame.rows())]
    return view(type(result).__name__, [rows], text=repr(result))


def _account_view(
    account: Account,
    text: str,
    tables: Sequence[Sequence[Sequence[str]]] = (),
    more: Mapping[str, figure] | None = None,
) -> str:
    plots = {**account_plots(account), **(more or {})}
    shown = {caption: plots[name] for name, caption in SHOWN.items() if name in plots}
    heading = ["parameter", "symbol", "value", "standard error", "95 % interval", "unit"]
    parameters = [heading, *(row[:6] for row in parameter_table(account.final))]
    return view(
        account.summary, [*tables, parameters], account.left, text=text, figures=figures(shown)
    )


def view(
    summary: str,
    tables: Sequence[Sequence[Sequence[str]]] = (),
    sentences: Iterable[str] = (),
    *,
    text: str = "",
    picture: str = "",
    figures: Figures = NO_FIGURES,
) -> str:
    return render(
        "notebook.html",
        summary=summary,
        tables=tables,
        sentences=list(sentences),
        figures=figures,
        picture=picture,
        picture_of=summary,
        text=text,
        open=not tables and not figures.places,
    )


def figures(plots: Mapping[str, figure]) -> Figures:
    """The figures; the library with the first ones that this process shows.

    A notebook is one page, on which the library is needed once: it is longer than all figures.
    """
    made = figures_of(plots)
    if _loaded:
        return replace(made, library=Markup())
    _loaded.append(True)
    return made


def _fit_sentence(fit: Fit) -> str:
    unit = fit.model.torque_unit
    held_out = ""
    if fit.rmse_held_out is not None:
        held_out = f", held-out {plain(fit.rmse_held_out)} {unit}"
    return f"{fit.model.spec}: RMSE {plain(fit.rmse)} {unit}{held_out}"


def _steps(account: Account) -> list[list[list[str]]]:
    """A row for each step or finding; no table without any."""
    unit = account.final.model.torque_unit
    rows = [["effect", "confidence", f"held-out RMSE before [{unit}]", "after", "change"]]
    for step in account.steps:
        before, after = step.before.rmse_held_out, step.after.rmse_held_out
        sure = "" if step.confidence is None else confidence_words(step.confidence)
        errors = ["", "", ""]
        if before is not None and after is not None:
            errors = [plain(before), plain(after), change_text(before, after)]
        rows.append([step.effect, sure, *errors])
    return [rows] if account.steps else []


def cell(value: object) -> str:
    return plain(value, 5) if isinstance(value, float) else "" if value is None else str(value)

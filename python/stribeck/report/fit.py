"""A fit as text and figure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stribeck.identify.figures import torque_cutoff
from stribeck.identify.search.algorithms import GAUSS_NEWTON
from stribeck.report.channels import clock, torque_name
from stribeck.report.exogeneity import exogeneity_text
from stribeck.report.layout import joined, notes_text, paragraph
from stribeck.report.numbers import change_text, minus_signs, percent, plain
from stribeck.report.parameters import (
    correlation_text,
    effective_text,
    not_identifiable_text,
    open_text,
    parameters_text,
    per_run_text,
    temperature_text,
)
from stribeck.report.recording import file_name, held_out_meaning, scored_sentence
from stribeck.report.residual import velocity_panel
from stribeck.report.stated import stated_text
from stribeck.report.style import (
    AFTER,
    MEASURED,
    broken,
    legend_above,
    limits,
    new_figure,
    over_time,
    style,
    thin,
    title,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.fitting.result import Fit
    from stribeck.identify.errors.estimates import Errors

PASSIVITY = {
    True: "Passive: this friction is proved to generate no energy within its operating box.",
    False: "Not passive: somewhere in its operating box this friction generates energy (a "
    "passivity check shows where).",
    None: "Whether this friction is passive within its operating box could not be decided.",
}

#: Relative residual from which on a model explains hardly any of the torque.
HARDLY = 0.9
#: Probability of another place above which more starts are advised.
UNSURE = 0.5

#: What standard errors assume, or from what they follow.
ASSUMED: dict[Errors, str] = {
    "robust": "allowing for noise that is correlated in time",
    "independent": "assuming independent errors of the samples",
    "profile": "allowing for noise that is correlated in time",
    "bootstrap": "from refits to resampled blocks of the recording",
}
#: From what intervals follow where they are not symmetric.
INTERVALS: dict[Errors, str] = {
    "profile": " Intervals are those of the profile likelihood.",
    "bootstrap": " Intervals are quantiles of the refits.",
}


def fit_text(fit: Fit) -> str:
    """A fit at a glance."""
    r = fit.recording
    search = _search_sentence(fit)
    legend = _errors_legend(fit)
    return joined(
        f"{fit.model.spec} {'fitted to' if search else 'evaluated on'} {file_name(r)}",
        paragraph(search + scored_sentence(r)),
        parameters_text(fit.estimates, fit.errors in INTERVALS) + ("\n" + legend if legend else ""),
        per_run_text(fit.per_run),
        temperature_text(fit.model),
        open_text(fit.estimates),
        not_identifiable_text(fit.estimates, fit.combinations),
        correlation_text(fit.correlation),
        stated_text(fit),
        errors_text(fit),
        _criteria_text(fit),
        paragraph(exogeneity_text(fit)),
        paragraph(PASSIVITY[fit.passive()] + _cost_sentence(fit)),
        "" if fit.converged else paragraph(f"The search did not converge ({fit.outcome})."),
        notes_text(r.notes, fit.notes),
    )


def _search_sentence(fit: Fit) -> str:
    """How the parameters were searched; nothing where they were not."""
    if fit.starts == 0:
        return ""
    work = f"{fit.evaluations} evaluations, {fit.seconds:.1f} s. "
    found = fit.search
    if found is None or fit.starts == 1:
        return f"Search: {fit.starts} start{'s' if fit.starts > 1 else ''}, {work}"
    by = "" if found.algorithm == GAUSS_NEWTON else f" by {found.algorithm}"
    said = f"Search{by}: {fit.starts} starts, {found.at_minimum} of them at the minimum, {work}"
    if found.new_place is not None and found.new_place > UNSURE:
        said += (
            f"Another start would end at a new place with probability {found.new_place:.2f}: more "
            "starts may find a better minimum. "
        )
    return said


def _criteria_text(fit: Fit) -> str:
    """The information criteria, where the fit has some."""
    found = fit.information
    if found is None or fit.starts == 0:
        return ""

    aic, bic = (minus_signs(f"{value:.1f}") for value in (found.aic, found.bic))
    return paragraph(f"AIC {aic}, BIC {bic}, for {effective_text(found)}.")


def _errors_legend(fit: Fit) -> str:
    """What the standard errors mean, where there are some."""
    if all(e.stderr is None for e in fit.estimates.values()):
        return ""
    return paragraph(
        f"± is one standard error, {ASSUMED[fit.errors]}. It does not account for effects that the "
        f"model lacks.{INTERVALS.get(fit.errors, '')}"
    )


def errors_text(fit: Fit) -> str:
    """The errors of a fit, one a line."""
    unit, r = fit.model.torque_unit, fit.recording
    meaning = "root mean square over the scored samples"
    rows = [("error (RMSE)", f"{plain(fit.rmse)} {unit}", meaning)]
    if fit.rmse_held_out is not None:
        rows.append(("held-out error", f"{plain(fit.rmse_held_out)} {unit}", held_out_meaning(fit)))
    rows += _weighted_rows(fit)
    rows += [
        ("other recording", f"{plain(one.rmse)} {unit}", f"not fitted: {Path(one.file).name}")
        for one in fit.evaluated
    ]
    if fit.relative_residual is not None:
        cutoff = torque_cutoff(r)
        below = f", both below {cutoff:.3g} Hz" if cutoff else ""
        rows.append(
            ("relative residual", percent(fit.relative_residual), f"held-out error / torque{below}")
        )
    first, second = max(len(a) for a, _, _ in rows), max(len(b) for _, b, _ in rows)
    lines = [f"  {a:<{first}}  {b:>{second}}  {c}" for a, b, c in rows]
    warning = hardly_explained(fit)
    return "\n".join([*lines, "", paragraph(warning, 2)] if warning else lines)


def hardly_explained(fit: Fit) -> str:
    """That a model explains hardly any of the torque, where it does not."""
    if fit.relative_residual is None or fit.relative_residual <= HARDLY:
        return ""
    return (
        f"{fit.model.spec} explains hardly any of the torque, so that its values say nothing about "
        f"friction. Something else moves or loads this joint (other joints, a contact, a hand), or "
        f"a column is that of another joint."
    )


def _weighted_rows(fit: Fit) -> list[tuple[str, str, str]]:
    """The weighted errors, where samples have weights."""
    unit, rows = fit.model.torque_unit, []
    if fit.rmse_weighted is not None:
        rows.append(("weighted error", f"{plain(fit.rmse_weighted)} {unit}", "with the weights"))
    if fit.rmse_held_out_weighted is not None:
        figure = f"{plain(fit.rmse_held_out_weighted)} {unit}"
        rows.append(("weighted held-out", figure, "held-out error with the weights"))
    return rows


def _cost_sentence(fit: Fit) -> str:
    """What passivity costs, where it was asked for; with a space before it."""
    cost = fit.passive_cost
    if cost is None:
        return ""
    if not cost.imposed:
        return " Passivity costs nothing here: the best fit is already passive."
    unit = fit.model.torque_unit
    change = change_text(cost.rmse_free, fit.rmse)
    sentence = (
        f" Imposing passivity, at {cost.conditions} operating points and cycles, changes the RMSE "
        f"from {plain(cost.rmse_free)} to {plain(fit.rmse)} {unit} ({change})"
    )
    if cost.rmse_held_out_free is None or fit.rmse_held_out is None:
        return sentence + "."
    held_out = f"{plain(cost.rmse_held_out_free)} to {plain(fit.rmse_held_out)} {unit}"
    return f"{sentence} and the held-out RMSE from {held_out}."


def fit_figure(fit: Fit) -> Figure:
    """Measured and modelled torque over time, the residual, and the friction curve."""
    figure = new_figure(12.0, 9.0)
    grid = figure.add_gridspec(3, 2, height_ratios=[1.15, 0.8, 1.15])
    top, middle = figure.add_subplot(grid[0, :]), figure.add_subplot(grid[1, :])
    left, right = figure.add_subplot(grid[2, 0]), figure.add_subplot(grid[2, 1])
    for axes in (top, middle, left, right):
        style(axes)
    _over_time(top, middle, fit)
    _friction_panel(left, fit)
    velocity_panel(right, fit, AFTER)
    return figure


def _over_time(top: Axes, middle: Axes, fit: Fit) -> None:
    """Torque and residual over the same time."""
    r, unit, time = fit.recording, fit.model.torque_unit, clock(fit.recording)
    what = torque_name(unit)
    over_time(top, r, time.values, r.torque, MEASURED, (2.4, 5.0), "measured", 0.5)
    modelled = broken(r, fit.prediction)
    over_time(top, r, time.values, modelled, AFTER, (0.9, 3.0), fit.model.spec)
    top.margins(x=0.01)
    top.set_ylabel(f"{what} [{unit}]")
    title(top, f"Measured and modelled {what}")
    legend_above(top)
    top.tick_params(labelbottom=False)
    middle.sharex(top)
    zero_line(middle)
    over_time(middle, r, time.values, broken(r, fit.residual), AFTER, (0.9, 3.0))
    limits(middle, [fit.residual[r.moving]])
    middle.set_ylabel(f"residual [{unit}]")
    middle.set_xlabel(time.label)
    title(middle, f"Residual (measured minus modelled): RMSE {plain(fit.rmse)} {unit}")


def _friction_panel(axes: Axes, fit: Fit) -> None:
    """Friction against velocity, measured and modelled."""
    r, unit = fit.recording, fit.model.torque_unit
    what, load = torque_name(unit), fit.load_torque
    some = thin(np.flatnonzero(r.moving))
    # The prediction contains the torque of an identified rigid body or of a known load.
    rest = np.zeros_like(r.torque) if load is None else load
    for values, colour, size, alpha, label in (
        (r.torque, MEASURED, 6.0, 0.35, "measured"),
        (fit.prediction, AFTER, 2.2, 1.0, fit.model.spec),
    ):
        axes.plot(
            r.velocity[some],
            (values - rest)[some],
            ".",
            color=colour,
            markersize=size,
            alpha=alpha,
            label=label,
            markeredgewidth=0,
            rasterized=True,
        )
    name = what if load is None else f"friction {what}"
    without = "" if load is None else f" ({what} minus load)"
    axes.set_xlabel(f"velocity [{r.position_unit}/s]")
    axes.set_ylabel(f"{name} [{unit}]")
    title(axes, f"{name[0].upper()}{name[1:]} against velocity{without}")

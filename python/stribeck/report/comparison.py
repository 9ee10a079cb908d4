"""Models side by side: text and figure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from stribeck.report.channels import torque_name
from stribeck.report.layout import joined, line_width, notes_text, paragraph, table, width_of
from stribeck.report.names import model_names
from stribeck.report.numbers import percent, plain, signed
from stribeck.report.parameters import effective_text
from stribeck.report.recording import REGIMES, blocks_meaning, file_name, scored_sentence
from stribeck.report.residual import residual_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.diagnosis.compare import Assessment, Comparison
    from stribeck.identify.errors.information import Information

#: A regime is marked where its RMSE is this multiple of that of all scored samples.
MARKED = 1.2
REGIMES_LEGEND = (
    f"▲ marks an RMSE of at least {MARKED} times that of all scored samples; the mean error is "
    "measured minus modelled."
)
#: Columns of models in one table, and the longest spec that heads one.
MOST_COLUMNS, LONGEST = 3, 16


def comparison_text(comparison: Comparison) -> str:
    """Models side by side, and where each fails."""
    r, unit = comparison.recording, comparison.recording.torque_unit
    models = comparison.models
    floor = f"No noise floor: {comparison.noise_floor_why}."
    if comparison.noise_floor is not None:
        floor = noise_floor_sentence(comparison.noise_floor, unit)
    return joined(
        f"{len(models)} model{'s' if len(models) > 1 else ''} on {file_name(r)}",
        paragraph(scored_sentence(r)),
        _overview(comparison),
        paragraph(f"Held-out: {compared(comparison)}. {criteria(models)}{floor}"),
        _regimes_text(comparison),
        notes_text(r.notes, *(a.fit.notes for a in models)),
    )


def comparison_figure(comparison: Comparison) -> Figure:
    """Residual of each model against each channel."""
    return residual_figure([assessment.fit for assessment in comparison.models])


def noise_floor_sentence(floor: float, unit: str) -> str:
    """The noise floor, and what it is."""
    return (
        f"Noise floor {plain(floor)} {unit}: the smallest error that any function of the recorded "
        f"channels can have, estimated from repeats of the same state. The estimate improves with "
        f"the model."
    )


def _overview(comparison: Comparison) -> str:
    """One line a model; long specs are numbered, and listed below."""
    models = comparison.models
    heading, *rows = overview_rows(comparison)
    figures = [row[1:] for row in rows]
    columns = range(1, len(heading))
    names = _names(models)
    numbers = [f"[{k}]" for k in range(1, len(models) + 1)]
    shown = table([heading, *_beside(numbers, figures)], right=columns)
    if width_of(shown) + max(map(len, names)) - len(heading[0]) <= line_width():
        return table([heading, *_beside(names, figures)], right=columns)
    listed = [f"  {tag} {name}" for tag, name in zip(numbers, names, strict=True)]
    return joined(shown, "\n".join(listed))


def overview_rows(comparison: Comparison) -> list[list[str]]:
    """A heading, and one row a model with its errors over all scored samples."""
    models, unit = comparison.models, comparison.recording.torque_unit
    heading = ["model", f"RMSE [{unit}]", "held-out", "rel. residual", "R²", "mean error"]
    if len(_known(models)) > 1:
        heading += ["ΔAIC", "ΔBIC"]
    with_energy = any(a.energy is not None for a in models)
    if with_energy:
        heading.append("energy error")
    return [
        heading,
        *(
            [name, *_figures(a), *differences, *([_energy_error(a)] if with_energy else [])]
            for name, a, differences in zip(
                _names(models), models, _differences(models), strict=True
            )
        ),
    ]


def _names(models: Sequence[Assessment]) -> list[str]:
    return model_names([assessment.fit for assessment in models])


def _beside(names: list[str], figures: list[list[str]]) -> list[list[str]]:
    return [[name, *row] for name, row in zip(names, figures, strict=True)]


def _figures(a: Assessment) -> list[str]:
    return [
        plain(a.rmse),
        "same data" if a.rmse_held_out is None else plain(a.rmse_held_out),
        "" if a.relative_residual is None else percent(a.relative_residual),
        f"{a.r2:.4f}",
        signed(a.mean, a.rmse),
    ]


def _differences(models: Sequence[Assessment]) -> list[list[str]]:
    """AIC and BIC of each model minus the lowest ones; nothing with less than two models."""
    known = _known(models)
    if len(known) < 2:
        return [[] for _ in models]
    aic, bic = min(i.aic for i in known), min(i.bic for i in known)
    return [
        ["", ""] if i is None else [f"{i.aic - aic:.1f}", f"{i.bic - bic:.1f}"]
        for i in (a.information for a in models)
    ]


def criteria(models: Sequence[Assessment]) -> str:
    """What the differences of the information criteria are; with a space after it."""
    known = _known(models)
    if len(known) < 2:
        return ""
    return (
        f"ΔAIC and ΔBIC are the information criteria minus the lowest ones, for "
        f"{effective_text(known[0])} of the residual with the smallest error. "
    )


def _known(models: Sequence[Assessment]) -> list[Information]:
    return [a.information for a in models if a.information is not None]


def _energy_error(a: Assessment) -> str:
    error = a.energy["error_percent"] if a.energy else math.nan
    return f"{error:+.1f} %" if math.isfinite(error) else ""


def compared(comparison: Comparison) -> str:
    """What "held-out" means: specs are fitted here, model files are not."""
    stored = [a.fit.starts == 0 for a in comparison.models]
    file = (
        "a model read from a file is not refitted, and its error is held-out unless it was fitted "
        "to this data"
    )
    if all(stored):
        return file
    fitted = blocks_meaning(comparison.recording)
    return f"{fitted}; {file}" if any(stored) else fitted


def _regimes_text(comparison: Comparison) -> str:
    """RMSE by regime: one column a model, the worst places marked."""
    models = comparison.models
    if not models or not models[0].regimes:
        return ""
    blocks = [_regimes_block(comparison, first) for first in range(0, len(models), MOST_COLUMNS)]
    legend = f"Where each model fails: {REGIMES_LEGEND}"
    return joined(paragraph(legend), *blocks)


def _regimes_block(comparison: Comparison, first: int) -> str:
    """The table of a few models, from the one numbered `first` on."""
    part = comparison.models[first : first + MOST_COLUMNS]
    names = _names(comparison.models)[first : first + MOST_COLUMNS]
    tags = [n if len(n) <= LONGEST else f"[{first + k}]" for k, n in enumerate(names, 1)]
    heading = [f"RMSE (mean error) [{comparison.recording.torque_unit}]", "share", *tags]
    rows = [heading]
    for index, regime in enumerate(part[0].regimes):
        cells = []
        for a in part:
            g = a.regimes[index]
            mark = "▲ " if g.regime != "standstill" and g.rmse > MARKED * a.rmse else ""
            cells.append(f"{mark}{plain(g.rmse)} ({signed(g.bias, g.rmse)})")
        rows.append([REGIMES[regime.regime], percent(regime.share), *cells])
    text = table(rows, right=range(1, len(heading)))
    long = [f"  {tag} {name}" for tag, name in zip(tags, names, strict=True) if tag[0] == "["]
    return "\n".join([text, *long])


def worst_places(assessment: Assessment, most: int = 3) -> list[str]:
    """The regimes in which a model has the largest errors, as sentences."""
    unit = assessment.fit.model.torque_unit
    rows = [
        g
        for g in assessment.regimes
        if g.regime != "standstill" and g.share > 0.005 and g.rmse > 1.15 * assessment.rmse
    ]
    rows.sort(key=lambda g: -g.rmse)
    sentences = []
    for g in rows[:most]:
        bias = ""
        if abs(g.bias) > 0.3 * g.rmse:
            bias = (
                f"; on average the measured {torque_name(unit)} is {plain(abs(g.bias))} {unit} "
                f"{'above' if g.bias > 0 else 'below'} the model"
            )
        sentences.append(
            f"{REGIMES[g.regime]}: RMSE {plain(g.rmse)} {unit}, "
            f"{g.rmse / assessment.rmse:.1f} times that of all scored samples{bias}"
        )
    return sentences

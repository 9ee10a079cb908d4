"""`stribeck.plot`: one figure of models on a recording, by name."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from stribeck.base.arguments import door
from stribeck.base.checks import check_choice, shown
from stribeck.base.errors import SpecError
from stribeck.base.files import save_figure
from stribeck.diagnosis.compare import compare
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.published.sets import PREFIX, published
from stribeck.recording.recording import Recording
from stribeck.recording.several.concat import Recordings, as_one
from stribeck.report.plots import friction, residual
from stribeck.report.plots.page import Page, width_in_mm

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: The figures by name.
FIGURES: dict[str, Callable[[Page], Figure]] = {
    "friction-velocity": friction.friction_velocity,
    "time": friction.over_time,
    "residual-velocity": residual.over_velocity,
    "residual-position": residual.over_position,
    "residual-temperature": residual.over_temperature,
    "hysteresis": friction.hysteresis,
    "warm-up": residual.warm_up,
    "spectrum": residual.spectrum,
}


@door()
def plot(
    recording: Recordings,
    models: Fit | Model | ModelFile | str | Sequence[Fit | Model | ModelFile | str],
    what: str = "friction-velocity",
    *,
    width: str | float = "single",
    path: str | os.PathLike[str] | None = None,
) -> Figure:
    """Draw one figure of models on a recording, in the column width of a journal.

    Parameters
    ----------
    recording : Recording or sequence of them
        Several are runs of one joint.
    models
        Fits, models with values, model files, ``"published:ID"``, or specs, which are fitted; one
        or a list.
    what : str
        ``"friction-velocity"``, ``"time"``, ``"residual-velocity"``, ``"residual-position"``,
        ``"residual-temperature"``, ``"hysteresis"``, ``"warm-up"`` or ``"spectrum"``.
    width : str or float
        ``"single"`` (88 mm), ``"double"`` (180 mm), or mm.
    path
        Write the figure to this file (.png, .svg, .pdf).

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    SpecError
        An unknown figure or width, or a recording that lacks what the figure shows.

    Examples
    --------
    >>> rec = sb.read("joint.csv")  # doctest: +SKIP
    >>> sb.plot(rec, ["coulomb", "lugre"], "hysteresis", path="h.pdf")  # doctest: +SKIP
    """
    check_choice("what", what, tuple(FIGURES))
    page = Page(width_in_mm(width), _fits(as_one(recording), models))
    figure = FIGURES[what](page)
    if path is not None:
        save_figure(figure, path)
    return figure


def _fits(
    recording: Recording,
    models: Fit | Model | ModelFile | str | Sequence[Fit | Model | ModelFile | str],
) -> tuple[Fit, ...]:
    """Each model on the recording; a spec is fitted."""
    given = models if isinstance(models, Sequence) and not isinstance(models, str) else [models]
    strange = [one for one in given if not isinstance(one, Fit | Model | ModelFile | str)]
    if strange or not given:
        among = f"{shown(strange[0])} is among `models`" if strange else "`models` is empty"
        raise SpecError(f"{among}: give a fit, a model, a spec, or a list of them")
    made: list[Fit] = []
    for one in given:
        if isinstance(one, str) and one.startswith(PREFIX):
            made.append(evaluate(published(one), recording))
        elif isinstance(one, str):
            made.append(fit(one, recording))
        elif isinstance(one, ModelFile):
            made.append(evaluate(one.model, recording, fitted_on=one.hashes))
        elif isinstance(one, Model):
            made.append(evaluate(one, recording))
        else:
            made.append(one)
    return tuple(a.fit for a in compare(made, recording, floor=False).models)

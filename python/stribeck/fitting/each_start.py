"""Fit one model from several starts, and keep where each of them ended."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.fitting.fit import fit, rows_to_fit
from stribeck.fitting.prediction import Prediction
from stribeck.fitting.result import Fit
from stribeck.fitting.rigid_body import needs_own_load
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.search import Effort, Ended, search_each
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


@dataclass(frozen=True)
class FittedStart:
    """The end of one of several starts; its errors are those of `Fit`."""

    model: Model
    rmse: float
    rmse_held_out: float | None
    converged: bool
    outcome: str
    evaluations: int

    @classmethod
    def of(cls, fitted: Fit) -> FittedStart:
        """Summarise a fit."""
        return cls(
            fitted.model,
            fitted.rmse,
            fitted.rmse_held_out,
            fitted.converged,
            fitted.outcome,
            fitted.evaluations,
        )


def fit_each(
    starts: Sequence[Model],
    recording: Recording,
    *,
    transient: NDArray[np.bool_],
    effort: Effort,
    seed: int = 0,
) -> list[FittedStart | StribeckError]:
    """Fit one model from several starts; an error takes the place of a start that failed.

    Each start is searched to its own minimum. Starts that meet on a subset of the samples continue
    as one; their outcome names the start that they merged with.

    Parameters
    ----------
    starts : Models
        One model with different values; its nonlinear parameters lie between bounds.
    transient, effort, seed
        As of `fit`.

    Raises
    ------
    FitError
        As of `fit`, where no start could be fitted.
    """
    made = starts[0]
    rows = rows_to_fit(made, recording, transient)
    if needs_own_load(made):
        # Each start identifies its own load torque, so the starts do not share one problem.
        def alone(start: Model) -> FittedStart:
            return FittedStart.of(
                fit(start, recording, starts=1, seed=seed, transient=transient, effort=effort)
            )

        return [_said(partial(alone, start)) for start in starts]
    lower, upper, first = scaled_bounds(made, recording)
    values = np.stack([start.values for start in starts])
    at = np.where(np.isfinite(values), np.clip(values, lower, upper), first)
    ends = search_each(Problem(recording, made, rows), lower, upper, at, effort)

    def reached(end: Ended) -> FittedStart:
        values, search = end.search.values, end.search
        model = made.with_values(values)
        found = Prediction.of(Problem(recording, model, rows), values, lower, upper, effort)
        errors = found.rmse, found.rmse_held_out
        return FittedStart(model, *errors, search.converged, search.outcome, end.evaluations)

    ended: dict[int, FittedStart | StribeckError] = {}
    fits = []
    for k, end in enumerate(ends):
        if end.leader == k:
            ended[k] = _said(partial(reached, end))
        fitted = ended[end.leader]
        if isinstance(fitted, FittedStart) and end.leader != k:
            outcome = f"merged with start {end.leader}: {fitted.outcome}"
            fitted = replace(fitted, outcome=outcome, evaluations=end.evaluations)
        fits.append(fitted)
    return fits


def _said(work: Callable[[], FittedStart]) -> FittedStart | StribeckError:
    try:
        return work()
    except StribeckError as error:
        return error

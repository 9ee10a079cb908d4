"""Instruments of a fit, and the test of whether least squares is biased."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from stribeck.base.checks import check_choice
from stribeck.base.errors import FitError, SpecError, StribeckError, option
from stribeck.identify.errors.estimates import Estimate
from stribeck.identify.instrumental.exogeneity import Exogeneity, exogeneity
from stribeck.identify.instrumental.instruments import Instruments
from stribeck.identify.instrumental.reference_motion import along_reference, follows, lag
from stribeck.identify.problem import Problem
from stribeck.models.model import Model
from stribeck.models.rigid_body import needs_own_load, own_load
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights

Array = NDArray[np.float64]


#: Names of the estimators of a fit.
ESTIMATORS = ("ls", "iv")


def check_estimator(estimator: str, recording: Recording, *, passive: bool) -> None:
    """Refuse an estimator that does not exist, or that the recording gives no instruments for.

    Raises
    ------
    SpecError, FitError
        Instrumental variables need a reference trajectory that the motion follows.
    """
    check_choice("estimator", estimator, ESTIMATORS)
    if estimator == "ls":
        return
    if passive:
        raise SpecError(
            f"{option('estimator', 'iv')} fits without passivity conditions: omit it, or "
            f"{option('passive')}"
        )
    refuse_weights("an estimate by instrumental variables", recording)
    if recording.reference_velocity is None:
        given = option("map", "reference_position=COLUMN")
        raise FitError(
            f"{recording.path} has no reference trajectory, which {option('estimator', 'iv')} "
            f"needs: name its column with {given}, or fit by least squares"
        )
    if not follows(recording):
        raise FitError(
            f"the motion of {recording.path} does not follow its reference trajectory: correct "
            f"{option('map', 'reference_position=COLUMN')} or its unit, or fit by least squares"
        )


def instruments_of(
    model: Model, recording: Recording, rows: NDArray[np.intp], load: Array | None
) -> Instruments:
    """The instruments of a model with its values, on `rows` where the reference clearly moves."""
    along = along_reference(recording)
    beside = own_load(model, along) if needs_own_load(model) else load
    return Instruments.of(Problem(recording, model, rows, load), along, beside)


def tested(
    model: Model,
    recording: Recording,
    rows: NDArray[np.intp],
    load: Array | None,
    estimates: Mapping[str, Estimate],
) -> Exogeneity | None:
    """The Durbin-Wu-Hausman test of a fit by least squares; None without a usable reference.

    It compares estimators without weights, so that there is none of a weighted fit.
    """
    if recording.weight is not None:
        return None
    if recording.reference_velocity is None or not follows(recording):
        return None
    free = [e.identifiable and not e.held and not e.at_bound for e in estimates.values()]
    try:
        instruments = instruments_of(model, recording, rows, load)
        return exogeneity(instruments, model.values, np.array(free), lag(recording))
    except StribeckError:
        # The law has no limit somewhere on the reference motion: there are no instruments.
        return None

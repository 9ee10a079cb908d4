"""The effort that a model predicts on a recording, without a refit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.prediction import refuse_infinite
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import check_channels
from stribeck.models.model import Model
from stribeck.models.rigid_body import own_load
from stribeck.recording.recording import Recording

__all__ = ["predicted"]

Array = NDArray[np.float64]


def predicted(model: Model, recording: Recording) -> tuple[Array, Array | None]:
    """The predicted effort of every sample, and the load of the model's own rigid body.

    Returns
    -------
    prediction : array [n]
        In the unit of the model's effort.
    load : array [n], optional
        None where the model has no rigid body.

    Raises
    ------
    FitError, RecordingError
        A channel is missing, the channels contradict each other, the rigid body would be counted
        twice, or the model is of another kind of joint.
    """
    _refuse_other_joint(model, recording)
    recording.require_consistent()
    check_channels(model, recording)
    if recording.load_torque is not None and model.rigid_body:
        raise FitError(
            f"the model {model.spec} contains an identified rigid body, and {recording.path} "
            f"has load_torque: use a model that was fitted on data with load_torque"
        )
    load = own_load(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving), load)
    prediction = problem.predict(model.values)
    refuse_infinite(problem, prediction)
    return prediction, load


def _refuse_other_joint(model: Model, recording: Recording) -> None:
    """Refuse a model of a revolute joint for a prismatic one, and the other way round.

    Raises
    ------
    FitError
        Their positions have different units.
    """
    if model.position_unit != recording.position_unit:
        units = f"{recording.torque_unit} and {recording.position_unit}"
        raise FitError(
            f"{model.spec} is in {model.torque_unit} and {model.position_unit}, and "
            f"{recording.path} in {units}: it is a model of another kind of joint; give one in "
            f"{units}"
        )

"""Fits of a law to a joint, one from each start."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.fitting.each_start import FittedStart, fit_each
from stribeck.identify.scaling import model_for
from stribeck.identify.search.effort import THOROUGH
from stribeck.identify.stated.choices import Choices
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.scale.study.desk import Desk
from stribeck.scale.study.plan import Job

#: The search of a reported fit, so that both find the same minimum. Held-out blocks are predicted
#: by the linearised model, which saves ten fits for each start.
EFFORT = replace(THOROUGH, exact=False)


@dataclass(frozen=True)
class Trial:
    """Result of one start.

    Attributes
    ----------
    rmse, rmse_held_out
        Over the scored samples, in the unit of torque; None if the fit failed.
    parameters
        Values by name, in the units of the model.
    seconds
        Time of the law on the joint, divided by the number of starts.
    constants, rigid_body
        The constants and rigid-body terms of the model.
    failure
        Why there is no fit; empty if there is one.
    """

    job: Job
    rmse: float | None
    rmse_held_out: float | None
    converged: bool
    outcome: str
    evaluations: int
    seconds: float
    parameters: Mapping[str, float]
    constants: Mapping[str, float]
    rigid_body: tuple[str, ...]
    failure: str = ""

    def model(self, recording: Recording) -> Model:
        """The fitted model."""
        made = replace(
            model_for(self.job.law, recording),
            constants=dict(self.constants),
            rigid_body=self.rigid_body,
            values=np.empty(0),
        )
        return made.with_values([self.parameters[name] for name in made.names])


def fit_trials(desk: Desk, jobs: Sequence[Job]) -> list[Trial]:
    """Fit all starts of a law on a joint."""
    joint = jobs[0].joint
    plan = desk.plan
    return run_trials(jobs, desk.recording(joint), desk.transient(joint), plan.seed, plan.choices)


def run_trials(
    jobs: Sequence[Job],
    recording: Recording,
    transient: NDArray[np.bool_],
    seed: int,
    choices: Choices | None = None,
) -> list[Trial]:
    """Fit a law from its starts; an error is part of the result and is not raised.

    Parameters
    ----------
    jobs
        All starts of one law on one joint.
    transient : bool array [n]
        Samples excluded from the fits (`stribeck.identify.left_out.transients`).
    """
    began = time.perf_counter()
    fits: Sequence[FittedStart | StribeckError]
    try:
        model = model_for(jobs[0].law, recording)
        if choices is not None:
            model = choices.about(model).applied(model)
        effort = EFFORT.by(model.stated.algorithm)
        fits = fit_each(
            model, recording, starts=len(jobs), seed=seed, transient=transient, effort=effort
        )
    except StribeckError as error:
        fits = [error] * len(jobs)
    except Exception as error:
        # One defect must not end a study of hours; it is listed with the fits.
        sentence = f"unexpected {type(error).__name__}: {error}; please report it"
        fits = [StribeckError(sentence.replace("\n", " "))] * len(jobs)
    seconds = (time.perf_counter() - began) / len(jobs)
    return [_trial(job, fitted, seconds) for job, fitted in zip(jobs, fits, strict=True)]


def _trial(job: Job, fitted: FittedStart | StribeckError, seconds: float) -> Trial:
    if isinstance(fitted, StribeckError):
        return Trial(job, None, None, False, "failed", 0, seconds, {}, {}, (), str(fitted))
    return Trial(
        job=job,
        rmse=fitted.rmse,
        rmse_held_out=fitted.rmse_held_out,
        converged=fitted.converged,
        outcome=fitted.outcome,
        evaluations=fitted.evaluations,
        seconds=seconds,
        parameters={
            n: float(x) for n, x in zip(fitted.model.names, fitted.model.values, strict=True)
        },
        constants={name: float(value) for name, value in fitted.model.constants.items()},
        rigid_body=fitted.model.rigid_body,
    )

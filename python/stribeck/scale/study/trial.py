"""The fits of a law on a joint: one from each start."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.fitting.each_start import FittedStart, fit_each
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search import Effort
from stribeck.identify.space import SearchSpace
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.scale.study.desk import Desk
from stribeck.scale.study.plan import Job

#: Each start is brought to its own minimum on all rows. Held-out blocks are predicted by the
#: linearised model, which spares running every start ten times.
EFFORT = Effort(finished=1, tolerance=1e-8, exact=False)


@dataclass(frozen=True)
class Trial:
    """Where one start ended.

    Attributes
    ----------
    rmse, rmse_held_out
        Over the scored rows, in the unit of torque; None where the fit failed.
    parameters
        Values by name, in the units of the model.
    seconds
        Its part of the time that the law took on the joint: starts share much of it.
    constants, rigid_body
        The fixed numbers and the rigid-body terms that belong to the model.
    failure
        Why there is no fit; empty where there is one.
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


def start_model(law: str, recording: Recording, start: int, seed: int) -> Model:
    """The model from which a start sets out.

    Start 0 is the catalog's. The others draw the nonlinear parameters evenly between their bounds
    (by their logarithm, where a bound above zero allows it) as the review does, with numbers that
    depend on seed and start alone; linear parameters follow from the nonlinear ones.
    """
    model = model_for(law, recording)
    lower, upper, first = bounds(model, recording)
    search = SearchSpace(model, lower, upper)
    values = np.full(len(model.names), np.nan)
    values[search.nonlinear] = first[search.nonlinear]
    if start > 0:
        rng = np.random.default_rng([seed, start])
        values[search.nonlinear] = search.decode(rng.uniform(size=int(search.nonlinear.sum())))
    return model.with_values(values)


def fit_trials(desk: Desk, jobs: Sequence[Job]) -> list[Trial]:
    """The fits of a law on a joint, whose starts are all there or none."""
    joint = jobs[0].joint
    return run_trials(jobs, desk.recording(joint), desk.transient(joint), desk.plan.seed)


def run_trials(
    jobs: Sequence[Job], recording: Recording, transient: NDArray[np.bool_], seed: int
) -> list[Trial]:
    """Fit a law from its starts; what cannot be fitted is said, not raised.

    Parameters
    ----------
    jobs
        Of one law on one joint, the starts from 0 on.
    transient : bool array [n]
        Rows that no start is fitted to (`stribeck.identify.transients`).
    """
    began = time.perf_counter()
    fits: Sequence[FittedStart | StribeckError]
    try:
        starts = [start_model(job.law, recording, job.start, seed) for job in jobs]
        fits = fit_each(starts, recording, transient=transient, effort=EFFORT, seed=seed)
    except StribeckError as error:
        fits = [error] * len(jobs)
    except Exception as error:
        # One defect must not end the other fits of a study of hours; it is listed with them.
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

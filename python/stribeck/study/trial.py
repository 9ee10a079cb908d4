"""One fit of a study: a law on a joint from one start."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.errors import StribeckError
from stribeck.fit import Effort, fit
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.space import SearchSpace
from stribeck.model import Model
from stribeck.recording import Recording
from stribeck.study.plan import Job

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


def run_trial(job: Job, recording: Recording, transient: NDArray[np.bool_], seed: int) -> Trial:
    """Fit `job.law` from its start; what cannot be fitted is said, not raised.

    Parameters
    ----------
    transient : bool array [n]
        Rows that no start is fitted to (`stribeck.identify.transients`).
    """
    began = time.perf_counter()
    try:
        start = start_model(job.law, recording, job.start, seed)
        fitted = fit(start, recording, starts=1, seed=seed, transient=transient, effort=EFFORT)
    except StribeckError as error:
        return _failed(job, str(error), time.perf_counter() - began)
    except Exception as error:
        # One defect must not end the other fits of a study of hours; it is listed with them.
        sentence = f"unexpected {type(error).__name__}: {error}; please report it"
        return _failed(job, sentence.replace("\n", " "), time.perf_counter() - began)
    return Trial(
        job=job,
        rmse=fitted.rmse,
        rmse_held_out=fitted.rmse_held_out,
        converged=fitted.converged,
        outcome=fitted.outcome,
        evaluations=fitted.evaluations,
        seconds=time.perf_counter() - began,
        parameters={name: e.value for name, e in fitted.estimates.items()},
        constants={name: float(value) for name, value in fitted.model.constants.items()},
        rigid_body=fitted.model.rigid_body,
    )


def _failed(job: Job, sentence: str, seconds: float) -> Trial:
    return Trial(job, None, None, False, "failed", 0, seconds, {}, {}, (), sentence)

"""The problem of a law on a recording, as a search meets it."""

from __future__ import annotations

import numpy as np
import stribeck as sb
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.space import SearchSpace


def problem_of(recording: sb.Recording, law: str) -> tuple[Problem, SearchSpace, np.ndarray]:
    """The problem over the moving samples, the space of the search and the first start."""
    model = model_for(law, recording)
    lower, upper, start = bounds(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving))
    return problem, SearchSpace.of(problem, lower, upper), start

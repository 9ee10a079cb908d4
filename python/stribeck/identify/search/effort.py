"""How thoroughly a model is fitted."""

from __future__ import annotations

from dataclasses import dataclass, replace

from stribeck.identify.search.algorithms import GAUSS_NEWTON
from stribeck.identify.search.separable import TOLERANCE


@dataclass(frozen=True)
class Effort:
    """How thoroughly a model is fitted.

    Attributes
    ----------
    rows, samples
        Samples used for the coarse search of each start; contiguous ones, `samples`, where a model
        has a state.
    evaluations
        Most evaluations of one start; 0: the start is near the minimum and needs no search.
    finished
        Number of starts that continue on all samples, until the predicted relative decrease of the
        sum of squares is below `tolerance`.
    exact
        Whether held-out predictions evaluate the model at each refit, or its linearisation.
    algorithm
        Algorithm of the coarse search (`stribeck.identify.search.algorithms`).
    """

    rows: int = 4000
    samples: int = 12000
    evaluations: int = 60
    finished: int = 2
    tolerance: float = TOLERANCE
    exact: bool = True
    algorithm: str = GAUSS_NEWTON

    def by(self, algorithm: str | None) -> Effort:
        """The same effort with the search by `algorithm`, where one is given."""
        return self if algorithm is None else replace(self, algorithm=algorithm)


#: For a fit that is reported.
THOROUGH = Effort()
#: For one of many candidates whose values are roughly known.
QUICK = Effort(evaluations=0, finished=1, tolerance=1e-6, exact=False)
#: For a reported fit that starts close to the solution. With a million samples the values converge
#: to about a thousandth of their standard error.
FROM_NEARBY = replace(THOROUGH, evaluations=0, finished=1, tolerance=1e-12)

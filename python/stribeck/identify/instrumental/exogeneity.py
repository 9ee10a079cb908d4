"""Durbin-Wu-Hausman test: is the motion that least squares regards as known free of noise?

Least squares and instrumental variables agree up to their errors if the columns of least squares
are not correlated with the residual. In its augmented form (Hausman 1978; Davidson and MacKinnon
1993, section 7.9; applied to robots by Janot, Vandanjon and Gautier 2014) the test asks whether the
instruments explain a part of the residual of least squares that its own columns do not.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.errors.covariance import batches, correlation_length
from stribeck.identify.instrumental.instruments import Instruments, projection
from stribeck.identify.triangle import Triangle, least_squares, triangles
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: A result is stated as biased below this probability.
BIASED = 0.01
#: Parts of instruments below this share of their length are explained by the columns.
APART = 1e-6
#: Fewest and most batches of strokes.
FEWEST, MOST = 20, 200
#: A batch is at least this many correlation lengths long.
LENGTHS = 4.0


@dataclass(frozen=True)
class Exogeneity:
    """Result of the Durbin-Wu-Hausman test.

    Attributes
    ----------
    statistic
        Wald statistic, chi-squared distributed with `degrees_of_freedom` for many samples.
    p
        Probability of such a statistic without bias, by Hotelling's distribution for as many
        batches of samples as there are.
    bias
        Least squares minus instrumental variables to first order, by parameter, in its unit.
    lag
        Time in s by which the motion follows the reference.
    """

    statistic: float
    degrees_of_freedom: int
    p: float
    bias: Mapping[str, float]
    lag: float

    @property
    def biased(self) -> bool:
        """Whether least squares is biased at the 1 % level."""
        return self.p < BIASED

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "statistic": self.statistic,
            "degrees_of_freedom": self.degrees_of_freedom,
            "p": self.p,
            "biased": self.biased,
            "bias": dict(self.bias),
            "lag_s": self.lag,
        }


def stroke_batches(
    recording: Recording, rows: NDArray[np.intp], residual: Array
) -> NDArray[np.uint32]:
    """The batch of each of `rows` [m]: strokes between standstills, joined until long enough.

    Noise of a differentiated position nearly cancels within a stroke, so a batch that ends within
    one would look far noisier than the sum of all. Batches of equal length where strokes are few.
    """
    length = correlation_length(residual)
    new = np.diff(rows, prepend=rows[:1]) > 1
    direction = np.sign(recording.velocity[rows])
    new |= np.diff(direction, prepend=direction[:1]) != 0
    new |= np.diff(recording.segment[rows], prepend=recording.segment[rows[:1]]) != 0
    first = np.append(np.flatnonzero(new), rows.size)
    least = max(LENGTHS * length, rows.size / MOST)
    batch = np.zeros(rows.size, dtype=np.uint32)
    number, begin = 0, 0
    for end in first:
        if end - begin >= least and rows.size - end >= least:
            number, begin = number + 1, end
            batch[end:] = number
    return batch if number + 1 >= FEWEST else batches(rows.size, length)


def exogeneity(
    instruments: Instruments,
    values: Array,
    tested: NDArray[np.bool_],
    lag: float,
) -> Exogeneity | None:
    """Test the solution `values` [p] of least squares.

    Parameters
    ----------
    tested : bool array [p]
        Parameters that least squares identifies, away from their bounds.

    Returns
    -------
    Exogeneity or None
        None where the recording is too short, or the instruments are the columns themselves.
    """
    wanted = np.flatnonzero(tested)
    k = wanted.size
    if k == 0:
        return None
    residual, jacobian, z = instruments.linearise(values, wanted)
    batch = stroke_batches(instruments.along.recording, instruments.problem.rows, residual)
    count = int(batch.max()) + 1
    # The columns come first: the lower right block is what the instruments have beyond them.
    parts = triangles(np.hstack([jacobian, z]), residual, batch, count)
    both = Triangle.joined(parts)
    own = np.sqrt(np.einsum("ij,ij->j", both.factor[:, k:], both.factor[:, k:]))
    own = np.where(own > 0.0, own, 1.0)
    weights, vectors = linear.singular(both.factor[k:, k:] / own)
    apart = vectors[weights > APART].T / own[:, None]
    freedom = apart.shape[1]
    if freedom == 0 or count < 2 * freedom + 2:
        return None
    shared = both.factor[:k, k:] @ apart
    open_ = np.full(k, np.inf)
    explained = [least_squares(both.factor[:k, :k], column, -open_, open_) for column in shared.T]
    beyond = np.vstack([-np.stack(explained, axis=1), apart])
    scores = np.stack([part.factor.T @ part.right for part in parts]) @ beyond
    mean = scores.mean(axis=0)
    spread = Triangle.of(scores - mean, np.zeros(count)).covariance() * (count - 1)
    statistic = float(count * mean @ spread @ mean)
    share = (count - freedom) / (freedom * (count - 1))
    p = float(scipy.special.fdtrc(freedom, count - freedom, share * statistic))
    names = [instruments.problem.model.names[i] for i in wanted]
    return Exogeneity(statistic, freedom, p, dict(zip(names, _bias(parts, k), strict=True)), lag)


def _bias(parts: list[Triangle], k: int) -> list[float]:
    """Least squares minus instrumental variables after one step [k], from factors of ``[J Z]``."""
    swap = [*range(k, 2 * k), *range(k)]
    turned = [Triangle(part.factor[:, swap], part.right, part.rest) for part in parts]
    factor, right = projection(Triangle.joined(turned))
    open_ = np.full(k, np.inf)
    return [float(-x) for x in least_squares(factor, right, -open_, open_)]

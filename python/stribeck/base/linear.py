"""Linear algebra of small matrices, by the core on one thread.

The same machine gives the same bits whatever the number of threads; the last digits may differ
between types of processors.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import FitError

__all__ = [
    "least_norm",
    "length",
    "null_space",
    "pivots",
    "singular",
    "solve",
    "squares_left",
    "symmetric_eigen",
]

Array = NDArray[np.float64]


def least_norm(matrix: Array, right: Array, unseen: float | None = None) -> Array:
    """The x [n] of least norm that minimises ``|A x - b|``, from A [m, n] and b [m].

    Parameters
    ----------
    unseen
        Directions with a singular value below this share of the largest do not count. The default
        is the rounding error of the matrix, as in NumPy and LAPACK.

    Raises
    ------
    FitError
        If a number is not finite; so for all functions of this module.

    Examples
    --------
    >>> line = np.array([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]])
    >>> least_norm(line, np.array([2.0, 4.0, 6.0])).round(12)
    array([1., 1.])
    """
    share = max(matrix.shape) * np.finfo(float).eps if unseen is None else unseen
    with _named_errors():
        return _core.least_squares(matrix, right, share)


def squares_left(columns: Array, targets: Array) -> Array:
    """Sums of squares [k] that columns [m, n] leave of each target [m, k] by least squares.

    By their products, summed in a fixed order: for many samples and few columns.

    Examples
    --------
    >>> line = np.array([[1.0], [2.0], [3.0]])
    >>> squares_left(line, np.array([[2.0, 3.0], [4.0, 0.0], [6.0, -1.0]]))
    array([ 0., 10.])
    """
    n = columns.shape[1]
    size = np.sqrt(np.einsum("ij,ij->j", columns, columns))
    both = np.hstack([columns / np.where(size > 0.0, size, 1.0), targets])
    group = np.zeros(both.shape[0], dtype=np.uint32)
    ((products,), _, _) = _core.normal_equations(both, np.zeros(both.shape[0]), group, 1)
    own, rights = products[:n, :n], products[n:, :n]
    explained = np.array([right @ least_norm(own, right) for right in rights])
    return np.maximum(np.diag(products)[n:] - explained, 0.0)


def singular(matrix: Array) -> tuple[Array, Array]:
    """Singular values of A [m, n], the largest first, and right singular vectors, one a row.

    Returns
    -------
    values, vectors : arrays [n] and [n, n]
        Values beyond the m-th are zero. The signs of the vectors have no meaning.

    Examples
    --------
    >>> values, vectors = singular(np.array([[3.0, 0.0], [0.0, 5.0]]))
    >>> values, abs(vectors)
    (array([5., 3.]), array([[0., 1.],
           [1., 0.]]))
    """
    with _named_errors():
        return _core.singular(matrix)


def null_space(matrix: Array, unseen: float) -> Array:
    """Orthonormal basis [n, k] of the vectors that A [m, n] takes to zero.

    Parameters
    ----------
    unseen
        Singular values up to this share of the largest count as zero.

    Examples
    --------
    >>> abs(null_space(np.array([[1.0, 0.0]]), 1e-9))
    array([[0.],
           [1.]])
    """
    values, vectors = singular(matrix)
    return vectors[values <= unseen * values.max(initial=0.0)].T


def symmetric_eigen(matrix: Array) -> tuple[Array, Array]:
    """Eigenvalues [n] of a symmetric A [n, n], the smallest first, and eigenvectors, one a column.

    Examples
    --------
    >>> values, vectors = symmetric_eigen(np.array([[2.0, 1.0], [1.0, 2.0]]))
    >>> values.round(12)
    array([1., 3.])
    """
    with _named_errors():
        return _core.symmetric_eigen(matrix)


def solve(matrix: Array, right: Array) -> Array:
    """The solution of ``A x = b``, from A [n, n] and b [n] or [n, k].

    Raises
    ------
    FitError
        If A is singular.

    Examples
    --------
    >>> solve(np.array([[2.0, 0.0], [1.0, 1.0]]), np.array([2.0, 3.0]))
    array([1., 2.])
    """
    columns = right[:, None] if right.ndim == 1 else right
    with _named_errors():
        return _core.solve(matrix, columns).reshape(right.shape)


def pivots(matrix: Array) -> NDArray[np.intp]:
    """Order of the columns of A [m, n] in a QR decomposition with column pivoting.

    Each column is the longest outside the span of those before it.

    Examples
    --------
    >>> pivots(np.array([[1.0, 4.0, 0.0], [0.0, 0.0, 2.0]])).tolist()
    [1, 2, 0]
    """
    with _named_errors():
        return np.asarray(_core.pivots(matrix), dtype=np.intp)


def length(vector: Array) -> float:
    """Euclidean length of a vector [n].

    Examples
    --------
    >>> length(np.array([3.0, 4.0]))
    5.0
    """
    return float(np.sqrt(vector @ vector))


@contextmanager
def _named_errors() -> Iterator[None]:
    try:
        yield
    except _core.ModelError as error:
        raise FitError(f"a linear system of the fit has no solution: {error}") from error

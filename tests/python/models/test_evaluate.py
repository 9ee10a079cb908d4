"""Torque and gradient into an array that the caller keeps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import stribeck as sb
from numpy.typing import NDArray
from stribeck.base.errors import SpecError

Array = NDArray[np.float64]

#: More than one block of the core, and a part of one.
V = np.sin(0.02 * np.arange(700)) + 0.01
LUGRE = (4.0e3, 12.0, 4.9, 6.1, 9.3, 0.07, 1.7)


def lugre() -> sb.Model:
    return sb.model("lugre").with_values(LUGRE)


def delayed() -> sb.Model:
    return sb.model("coulomb+delay").with_values([0.5, 2.0, 0.004])


def stepped() -> sb.Model:
    """A law that runs sample by sample, because its state is not a bristle alone."""
    made = sb.model("coulomb+frictional_lag")
    return made.with_values([0.1 + 0.01 * k for k in range(len(made.names))])


@pytest.mark.parametrize("made", [lugre, delayed, stepped])
def test_the_result_is_written_and_returned(made: Callable[[], sb.Model]) -> None:
    """The bits are those of a fresh array, in whatever was there before."""
    model = made()
    torque, slopes = np.full(V.size, np.nan), np.full((V.size, len(model.names)), np.nan)
    assert model.torque(V, dt=0.002, out=torque) is torque
    assert model.gradient(V, dt=0.002, out=slopes) is slopes
    np.testing.assert_array_equal(torque, model.torque(V, dt=0.002))
    np.testing.assert_array_equal(slopes, model.gradient(V, dt=0.002))


def test_single_precision_is_written_too() -> None:
    out = np.empty(V.size)
    lugre().torque(V, dt=0.002, precision="single", out=out)
    np.testing.assert_array_equal(out, lugre().torque(V, dt=0.002, precision="single"))
    assert (out == out.astype(np.float32)).all()


def test_gradient_of_more_parameters_than_one_pass_takes() -> None:
    """A law that is stepped sample by sample takes them in passes."""
    model = sb.model("leuven:8")
    model = model.with_values([0.3 + 0.01 * k for k in range(len(model.names))])
    assert len(model.names) > 16
    out = np.empty((50, len(model.names)))
    np.testing.assert_array_equal(
        model.gradient(V[:50], dt=0.002, out=out), model.gradient(V[:50], dt=0.002)
    )


def test_columns_of_a_table_may_surround_the_result() -> None:
    """A column with gaps is copied, so that nothing is read from where the result goes."""
    table = np.asfortranarray(np.stack([V, np.zeros_like(V)], axis=1))
    out = table[:, 1]
    assert sb.model("coulomb", a1=0.5, a2=2.0).torque(table[:, 0], out=out) is out


def read_only() -> Array:
    made = np.empty(V.size)
    made.setflags(write=False)
    return made


@pytest.mark.parametrize(
    ("out", "said"),
    [
        ([0.0] * V.size, "give an array of float64"),
        (np.empty(V.size, np.float32), "`out` is an array of float32: give an array of float64"),
        (np.empty(V.size, ">f8"), "give an array of float64"),
        (np.ma.masked_array(np.empty(V.size)), "give an array of float64"),
        (np.empty(3), "`out` has the shape (3,): give an array of shape (700,)"),
        (np.empty((V.size, 1)), "give an array of shape (700,)"),
        (np.empty(2 * V.size)[::2], "`out` is not contiguous"),
        (read_only(), "or cannot be written to"),
        (V, "`out` shares memory with `velocity`: give another array"),
    ],
)
def test_what_cannot_receive_the_torque_is_refused(out: Array, said: str) -> None:
    before = V.copy()
    with pytest.raises(SpecError) as refused:
        sb.model("coulomb", a1=0.5, a2=2.0).torque(V, out=out)
    assert said in str(refused.value) and "\n" not in str(refused.value)
    np.testing.assert_array_equal(before, V)


def test_overlap_with_any_argument_is_refused() -> None:
    """A part of the step's memory, and the state."""
    memory = np.full(V.size + 1, 0.002)
    with pytest.raises(SpecError, match="shares memory with `dt`"):
        lugre().torque(V, dt=memory[:-1], out=memory[1:])
    state = np.zeros(V.size)
    with pytest.raises(SpecError, match="shares memory with `state`"):
        lugre().torque(V, dt=0.002, state=state[:1], out=state)


def test_the_gradient_has_its_own_shape() -> None:
    with pytest.raises(SpecError, match=r"`out` has the shape \(700,\)"):
        lugre().gradient(V, dt=0.002, out=np.empty(V.size))
    with pytest.raises(SpecError, match="is not contiguous, row by row"):
        lugre().gradient(V, dt=0.002, out=np.empty((V.size, 7), order="F"))


def test_every_channel_that_a_call_lacks_is_named() -> None:
    model = sb.Model("coulomb", effects=("inertia", "gravity"), values=[1.0, 2.0, 0.1, 0.2, 0.3])
    lacking = "needs the columns 'position' and 'acceleration': its inertia and gravity were ident"
    with pytest.raises(SpecError, match=lacking):
        model.torque([1.0])
    with pytest.raises(SpecError, match="position has 2 samples where the others have 3"):
        model.torque([1.0, 2.0, 3.0], position=[0.0, 1.0], acceleration=[0.0, 0.0, 0.0])

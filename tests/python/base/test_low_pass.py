import numpy as np
import pytest
import scipy.signal
from stribeck._core import ModelError
from stribeck.base.low_pass import first_order, zero_phase


@pytest.mark.parametrize("cutoff", [0.3, 5.0, 30.0, 70.0])
@pytest.mark.parametrize("padding", [1, 15, 99])
def test_is_the_filter_of_scipy(cutoff, padding):
    values = np.random.default_rng(3).normal(size=(3, 100)).cumsum(axis=1)
    sections = scipy.signal.butter(4, cutoff, fs=200.0, output="sos")
    expected = scipy.signal.sosfiltfilt(sections, values, padlen=padding)
    np.testing.assert_allclose(zero_phase(values, cutoff, 200.0, padding), expected, atol=1e-9)
    np.testing.assert_array_equal(
        zero_phase(values[1], cutoff, 200.0, padding),
        zero_phase(values, cutoff, 200.0, padding)[1],
    )


@pytest.mark.parametrize("cutoff", [0.0, 100.0, float("nan")])
def test_refuses_a_cutoff_out_of_range(cutoff):
    with pytest.raises(ModelError, match="below half the sampling rate"):
        zero_phase(np.zeros(40), cutoff, 200.0)


def test_first_order_is_the_filter_of_scipy():
    values, lag = np.random.default_rng(4).normal(size=300).cumsum(), 0.02
    share = -np.expm1(-0.005 / lag)
    expected = scipy.signal.lfilter([share], [1.0, share - 1.0], values)
    np.testing.assert_allclose(first_order(values, np.full(300, 0.005), lag), expected, atol=1e-12)


@pytest.mark.parametrize("lag", [0.0, -1.0, float("nan")])
def test_refuses_a_lag_that_is_none(lag):
    with pytest.raises(ModelError, match="a lag must be above zero"):
        first_order(np.zeros(40), np.ones(40), lag)

"""Results cross to the other process once, whole, and come back as the same objects."""

from __future__ import annotations

import multiprocessing
import threading

import numpy as np
import pytest
import stribeck as sb
from stribeck.report.workbench.exchange import Exchange
from synthetic import joint


@pytest.fixture
def ends() -> tuple[Exchange, Exchange]:
    here, there = multiprocessing.Pipe()
    return Exchange(here, "a"), Exchange(there, "b")


def crossed(one: Exchange, other: Exchange, message: object) -> object:
    """What arrives; a thread sends it, since a pipe holds less than a recording."""
    sending = threading.Thread(target=one.send, args=(message,))
    sending.start()
    arrived = other.receive()
    sending.join()
    return arrived


def test_arrays_of_every_kind_arrive(ends: tuple[Exchange, Exchange]) -> None:
    kept = np.arange(3.0)
    kept.flags.writeable = False
    sent = {
        "long": np.arange(300_000.0),
        "empty": np.empty((0, 2)),
        "columns": np.asfortranarray(np.arange(6).reshape(2, 3)),
        "every other": np.arange(10)[::2],
        "text": np.array(["a", None], dtype=object),
        "read only": kept,
    }
    got = crossed(*ends, sent)
    assert isinstance(got, dict)
    for name, values in sent.items():
        np.testing.assert_array_equal(got[name], values)
        assert got[name].dtype == values.dtype
        assert got[name].flags.writeable == (name != "read only")


def test_a_recording_crosses_once(ends: tuple[Exchange, Exchange]) -> None:
    one, other = ends
    recording = sb.read(joint(rows=3000))
    got = crossed(one, other, ("known", recording))
    assert isinstance(got, tuple)
    assert isinstance(got[1], sb.Recording)
    np.testing.assert_array_equal(got[1].torque, recording.torque)
    assert crossed(other, one, got[1]) is recording
    again = crossed(one, other, [recording, recording])
    assert isinstance(again, list)
    assert again[0] is again[1] is got[1]


def test_a_fit_names_the_recording_that_is_there(ends: tuple[Exchange, Exchange]) -> None:
    one, other = ends
    recording = sb.read(joint(rows=3000))
    there = crossed(one, other, recording)
    fit = crossed(one, other, sb.fit("coulomb", recording))
    assert isinstance(fit, sb.Fit)
    assert fit.recording is there
    assert fit.rmse == sb.fit("coulomb", recording).rmse

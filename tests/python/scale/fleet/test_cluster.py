"""The executor on a Dask client, with calls that end in each possible way."""

from __future__ import annotations

import logging
from concurrent.futures import CancelledError, Future
from concurrent.futures import wait as wait_for
from typing import Any

import pytest
from stribeck.scale.fleet.cluster import ClusterExecutor


class Remote:
    """A future of Dask that has ended, and whose outcome is fetched."""

    def __init__(self, outcome: object) -> None:
        self._outcome, self.dropped, self._ended = outcome, False, False
        self._callbacks: list[Any] = []

    def add_done_callback(self, callback: Any) -> None:
        self._callbacks.append(callback)

    def end(self) -> None:
        self._ended = True
        for callback in self._callbacks:
            callback(self)

    def cancel(self) -> None:
        self.dropped = True

    def cancelled(self) -> bool:
        return self._ended and isinstance(self._outcome, CancelledError)

    def result(self) -> object:
        if isinstance(self._outcome, Exception):
            raise self._outcome
        return self._outcome


class Client:
    """A client of Dask that keeps what was submitted."""

    def __init__(self, remote: Remote) -> None:
        self.remote, self.submitted = remote, []

    def submit(self, call: Any, *args: object, pure: bool) -> Remote:
        self.submitted.append((call, args, pure))
        return self.remote


def _ended(outcome: object) -> Future[Any]:
    remote = Remote(outcome)
    future = ClusterExecutor(Client(remote)).submit(abs, -1)  # type: ignore[arg-type]
    assert not future.done()
    remote.end()
    assert wait_for([future], timeout=1).done == {future}
    return future


def test_a_result_is_handed_over() -> None:
    assert _ended(7).result() == 7


def test_an_error_is_raised_here() -> None:
    with pytest.raises(ValueError, match="of the worker"):
        _ended(ValueError("of the worker")).result()


def test_what_the_cluster_drops_is_cancelled() -> None:
    assert _ended(CancelledError()).cancelled()


def test_what_the_cluster_drops_it_is_not_asked_to_drop() -> None:
    remote = Remote(CancelledError())
    future = ClusterExecutor(Client(remote)).submit(abs, -1)  # type: ignore[arg-type]
    remote.end()
    assert future.cancelled() and not remote.dropped


def test_a_call_that_is_cancelled_here_is_dropped_there() -> None:
    remote = Remote(7)
    client = Client(remote)
    future = ClusterExecutor(client).submit(abs, -1)  # type: ignore[arg-type]
    assert client.submitted == [(abs, (-1,), False)]
    assert future.cancel() and remote.dropped
    remote.end()
    assert future.cancelled()


def test_a_scheduler_that_is_lost_cannot_drop_a_call(caplog: pytest.LogCaptureFixture) -> None:
    class Lost(Remote):
        def cancel(self) -> None:
            raise OSError("the connection is closed")

    future = ClusterExecutor(Client(Lost(7))).submit(abs, -1)  # type: ignore[arg-type]
    with caplog.at_level(logging.ERROR):
        assert future.cancel()
    assert future.cancelled() and not caplog.records


def test_a_connection_that_is_closed_while_a_result_is_fetched_cancels_the_call() -> None:
    """So that it is told as lost, and not as a call that the worker cannot run."""
    iostream = pytest.importorskip("tornado.iostream")
    assert _ended(iostream.StreamClosedError()).cancelled()
    assert not _ended(OSError("of the call")).cancelled()

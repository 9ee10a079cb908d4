"""A Dask client as an executor that keeps results when the workers that hold them end.

`distributed.Client.get_executor` fetches a result, and reads afterwards whether the task has
failed. If the worker that holds the result ends between the two, it takes the result for an error.
"""

from __future__ import annotations

from asyncio import CancelledError as CancelledInLoop
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor, Future
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from distributed import Client
    from distributed import Future as DaskFuture

Result = TypeVar("Result")


class ClusterExecutor(Executor):
    """Calls on the workers of a Dask client, which the caller made and will close."""

    def __init__(self, client: Client) -> None:
        self._client = client

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Future[Result]:
        """Return the future of a call; if it is cancelled, the cluster drops the call."""
        here: Future[Result] = Future()
        remote = self._client.submit(fn, *args, pure=False, **kwargs)
        here.add_done_callback(lambda _: _drop(remote) if here.cancelled() else None)
        remote.add_done_callback(lambda ended: _hand_over(ended.result, here))
        return here


def _drop(remote: DaskFuture) -> None:
    """Have the cluster drop a call; one whose scheduler is lost cannot be asked to."""
    # Asking for a call that the cluster has dropped itself can take as long as the client looks for
    # its scheduler, and those who wait for the call would not be told before.
    if remote.cancelled():
        return
    with suppress(Exception, CancelledInLoop):
        remote.cancel()


def _hand_over(fetch: Callable[[], Result], here: Future[Result]) -> None:
    """Fetch the result of a call that has ended; Dask computes it again where it was lost.

    A call is cancelled where the scheduler drops it, or is lost before or while it is fetched.
    """
    try:
        result = fetch()
    except (CancelledError, CancelledInLoop):
        here.cancel()
        here.set_running_or_notify_cancel()
    except Exception as error:
        if _is_of_a_closed_connection(error):
            here.cancel()
        if here.set_running_or_notify_cancel():
            here.set_exception(error)
    else:
        if here.set_running_or_notify_cancel():
            here.set_result(result)


def _is_of_a_closed_connection(error: Exception) -> bool:
    """Whether an error says that the other side has closed the connection."""
    from distributed.comm.core import CommClosedError
    from tornado.iostream import StreamClosedError

    return isinstance(error, CommClosedError | StreamClosedError)

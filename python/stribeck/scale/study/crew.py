"""Who works on a study: this process, or several that stay to its end."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from stribeck.base.pool import LocalPool, Stopped, in_processes
from stribeck.identify.transients import transient_rows
from stribeck.recording.recording import Recording
from stribeck.scale.study.plan import Plan

Work = TypeVar("Work")
Result = TypeVar("Result")


class Desk:
    """What a process has at hand: the joint it read last, as pieces of work come joint by joint."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self._recording: tuple[str | None, Recording] | None = None
        self._transient: NDArray[np.bool_] | None = None

    def recording(self, joint: str | None) -> Recording:
        """The recording of a joint."""
        if self._recording is None or self._recording[0] != joint:
            self._recording = self._transient = None
            self._recording = joint, self.plan.read(joint)
        return self._recording[1]

    def transient(self, joint: str | None) -> NDArray[np.bool_]:
        """Rows of a joint that nothing is fitted to (`stribeck.identify.transients`)."""
        recording = self.recording(joint)
        if self._transient is None:
            self._transient = transient_rows(recording)
        return self._transient


@contextlib.contextmanager
def crew_of(plan: Plan, workers: int) -> Iterator[Crew]:
    """So many processes, to the end of the context; 1: this one."""
    if workers <= 1:
        yield Crew(plan, None)
        return
    with LocalPool(workers, _begin, (plan,)) as pool:
        yield Crew(plan, pool)


class Crew:
    """Does pieces of work of a study, each at a desk.

    Parameters
    ----------
    pool
        Processes with a desk each; None: here.
    """

    def __init__(self, plan: Plan, pool: LocalPool | None) -> None:
        self._desk, self._pool = Desk(plan), pool

    def each(
        self,
        do: Callable[[Desk, Work], Result],
        pieces: Iterable[Work],
        finished: Callable[[Result], None],
    ) -> None:
        """Do every piece, and hand each result over as it is ready, in any order.

        Parameters
        ----------
        do
            A function of a module: processes find it by name.

        Raises
        ------
        Stopped
            On Ctrl-C. Work under way is dropped at once.
        """
        if self._pool is not None:
            calls = ((do, piece) for piece in pieces)
            in_processes(_at_desk, calls, finished, self._pool, what="the study")
            return
        try:
            for piece in pieces:
                finished(do(self._desk, piece))
        except KeyboardInterrupt:
            raise Stopped from None


_desk: Desk | None = None


def _begin(plan: Plan) -> None:
    """Ready a process of the pool for its study."""
    global _desk
    _desk = Desk(plan)


def _at_desk(call: tuple[Callable[[Desk, Work], Result], Work]) -> Result:
    """A piece of work in a process of the pool."""
    assert _desk is not None
    do, piece = call
    return do(_desk, piece)

"""The torque balance of all samples of a data set, by passes over its files.

Each window is reduced to triangular factors and merged into those so far (sequential TSQR; Demmel,
Grigori, Hoemmen and Langou 2012), so that memory does not grow with the number of samples. Windows
have a fixed size and order: the bits do not depend on the memory of the computer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.robot.columns import RigidColumns, payload
from stribeck.robot.problem import CELLS, Balance, Factors, Values, places
from stribeck.scale.robots.data import RobotData, RobotWindow
from stribeck.scale.streaming.runs import numbered

__all__ = ["StreamedBalance"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


class _Sums:
    """Factors of one joint, cell by cell, while a pass adds to them."""

    def __init__(self, cells: int, width: int) -> None:
        self.whole = np.zeros((cells, width, width))

    def add(self, jacobian: Array, residual: Array, cell: Ints) -> None:
        """Add samples: ``J`` [m, p], ``r`` [m], and the cell of each, in order."""
        if not residual.size:
            return
        among = slice(int(cell[0]), int(cell[-1]) + 1)
        before = self.whole[among]
        count, width, _ = before.shape
        number = np.concatenate([np.repeat(np.arange(count), width), cell - among.start])
        self.whole[among] = _core.triangle(
            np.concatenate([before[:, :, :-1].reshape(-1, width - 1), jacobian]),
            np.concatenate([before[:, :, -1].ravel(), residual]),
            number.astype(np.uint32),
            count,
        )


@dataclass(frozen=True, kw_only=True)
class StreamedBalance(Balance):
    """The torque balance of all samples; `motion` is that of a part in memory.

    Attributes
    ----------
    data
        All samples.
    as_recorded
        Factors without the low-pass of joints whose torque is linear, and where they were made:
        they come with the first pass.
    """

    data: RobotData
    as_recorded: dict[int, tuple[Values, Factors]] = field(init=False, default_factory=dict)

    @property
    def rows(self) -> int:
        """Number of samples."""
        return self.data.data.rows

    @property
    def run_names(self) -> tuple[str, ...]:
        """Names of the runs."""
        return self.data.run_names

    @property
    def hashes(self) -> tuple[str, ...]:
        """SHA-256 of the files together, and of each of them."""
        return tuple(dict.fromkeys([self.data.data.sha256, *self.data.data.hashes]))

    @cached_property
    def scored_rows(self) -> NDArray[np.intp]:
        """Number of scored samples of each joint, at least 1, int array [N]."""
        return np.asarray(np.maximum(self.data.totals.scored, 1))

    def torque_size(self, joint: int) -> float:
        """RMS of a joint's filtered torque at its scored samples."""
        return float(np.sqrt(self.data.totals.torque_square[joint] / self.scored_rows[joint]))

    @cached_property
    def _borders(self) -> tuple[Ints, Ints]:
        """First samples of the groups that are held out, and of the cells."""
        first = self.data.joints[0]
        groups = first.starts if self.held_out == "runs" else first.edges[:-1]
        cells = -(-np.arange(CELLS) * self.rows // CELLS)
        return groups, np.unique(np.concatenate([groups, cells]))

    @cached_property
    def group_of_cell(self) -> NDArray[np.intp]:
        """What each cell is held out with, int array [cells]."""
        groups, cells = self._borders
        return np.asarray(numbered(cells, groups), dtype=np.intp)

    def load(self, base: Array) -> Array:
        """Torques of the rigid bodies in the part in memory, array [n, N]."""
        robot, motion = self.base.robot, self.motion
        parameters = np.zeros(self.base.mapping.shape[1])
        parameters[self.base.chosen] = base[: self.base.count]
        bodies = robot.with_bodies(parameters.reshape(len(robot.joints), -1))
        torque = robot.motor_torque(
            bodies.torque(motion.position, motion.velocity, motion.acceleration)
        )
        first = self.base.count
        for cause in self.causes:
            torque = torque + cause.columns @ base[first : first + cause.count]
            first += cause.count
        return torque

    def factors(
        self, values: Values, joints: Sequence[int] | None = None, *, filtered: bool = True
    ) -> list[Factors]:
        """The balance of some joints, by default of every joint, linearised at `values`.

        One pass over all samples, or none where what is asked for follows from an earlier one.
        """
        wanted = list(range(len(self.models)) if joints is None else joints)
        if filtered:
            linear = [j for j in wanted if self.is_linear(j) and j not in self.as_recorded]
            made = self._pass(values, [(j, True) for j in wanted] + [(j, False) for j in linear])
            for joint in linear:
                self.as_recorded[joint] = (values, made[joint, False])
            return [made[joint, True] for joint in wanted]
        missing = [(j, False) for j in wanted if j not in self.as_recorded]
        anew = self._pass(values, missing)
        return [
            self._moved(joint, values) if joint in self.as_recorded else anew[joint, False]
            for joint in wanted
        ]

    def _moved(self, joint: int, values: Values) -> Factors:
        """The factors of a linear joint as recorded, at other values."""
        at, factors = self.as_recorded[joint]
        place = places([f.size for f in values.friction], values.base.size)[joint]
        return factors.after((values.whole() - at.whole())[place])

    def _pass(
        self, values: Values, wanted: Sequence[tuple[int, bool]]
    ) -> dict[tuple[int, bool], Factors]:
        """Factors of some joints, after the low-pass or as recorded."""
        if not wanted:
            return {}
        cells = self.group_of_cell.size
        sums = {
            (joint, filtered): _Sums(cells, self.unknowns + values.friction[joint].size + 1)
            for joint, filtered in wanted
        }
        for window in self.data.windows(self.models):
            here, cell = self._of(window), numbered(window.row, self._borders[1])
            for (joint, filtered), sum_ in sums.items():
                jacobian, residual = here.linearised(values, joint, filtered=filtered)
                scored = window.motion.scored[:, joint]
                own = window.own[scored]
                sum_.add(jacobian[own], residual[own], cell[scored][own])
        return {key: Factors(sum_.whole) for key, sum_ in sums.items()}

    def _of(self, window: RobotWindow) -> Balance:
        """The balance of a window."""
        causes = tuple(payload(window.motion, cause.runs) for cause in self.causes)
        return Balance(RigidColumns(window.motion, self.base), self.models, causes)

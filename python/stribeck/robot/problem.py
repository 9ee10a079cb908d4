"""The torque balance of all joints: what is left of it, and its derivatives.

Torques are ``X b + f_j(p_j; motion, load)``: X is the regressor of the base parameters b, f_j the
friction of joint j, and its load the torque ``X b`` of the rigid bodies. Both sides pass the same
zero-phase low-pass (Gautier, Vandanjon, Presse, CDC 1994).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds
from stribeck.models.model import Model
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.columns import Cause, RigidColumns
from stribeck.robot.motion import RobotMotion

Array = NDArray[np.float64]

#: Contiguous stretches of samples, each within one run or block: batches of the standard errors.
CELLS = 60
#: The step in the load with which friction is differentiated, as a share of its size.
LOAD_STEP = 1e-4


@dataclass(frozen=True)
class Values:
    """Base parameters [b] and friction parameters of every joint [p_j]."""

    base: Array
    friction: tuple[Array, ...]

    def moved(self, step: Array, share: float = 1.0) -> Values:
        """The values after a step [b + sum p_j]."""
        sizes = np.cumsum([self.base.size, *(f.size for f in self.friction)])
        base, *friction = np.split(share * step, sizes[:-1])
        moved = tuple(f + change for f, change in zip(self.friction, friction, strict=True))
        return Values(self.base + base, moved)

    def whole(self) -> Array:
        """All of them, array [b + sum p_j]."""
        return np.concatenate([self.base, *self.friction])


@dataclass(frozen=True)
class Factors:
    """Triangular factors of the balance of one joint, cell by cell.

    Attributes
    ----------
    whole : array [cells, b + p_j + 1, b + p_j + 1]
        Factors of ``[J r]`` over base parameters and the joint's friction parameters.
    """

    whole: Array

    def after(self, step: Array) -> Factors:
        """The factors after a step [b + p_j], where the torque is linear in the parameters."""
        moved = self.whole.copy()
        moved[:, :, -1] -= self.whole[:, :, :-1] @ step
        return Factors(moved)

    def square(self, cells: NDArray[np.bool_]) -> float:
        """Sum of squares of r over some cells."""
        return float(np.sum(self.whole[cells, :, -1] ** 2))

    def squares_after(self, step: Array, cells: NDArray[np.bool_]) -> Array:
        """Sums of squares of some cells after a step [b + p_j], one a cell."""
        left = self.whole[cells, :, -1] - self.whole[cells, :, :-1] @ step
        return np.asarray(np.sum(left**2, axis=1))


@dataclass(frozen=True)
class Balance:
    """The torque balance of a robot with given laws, on a motion.

    Attributes
    ----------
    models
        Friction of each joint.
    causes
        What loads the joints beside the rigid bodies, such as a payload.
    by_block
        Whether blocks are held out although there are several runs.
    """

    rigid: RigidColumns
    models: tuple[Model, ...]
    causes: tuple[Cause, ...] = ()
    by_block: bool = False

    @property
    def motion(self) -> RobotMotion:
        """The motion."""
        return self.rigid.motion

    @property
    def base(self) -> BaseParameters:
        """The base parameters."""
        return self.rigid.base

    @property
    def rows(self) -> int:
        """Number of samples."""
        return self.motion.rows

    @property
    def run_names(self) -> tuple[str, ...]:
        """Names of the runs."""
        return self.motion.joints[0].run_names

    @property
    def hashes(self) -> tuple[str, ...]:
        """SHA-256 of what is fitted to, and of each of its files."""
        return self.motion.joints[0].hashes

    @cached_property
    def scored_rows(self) -> NDArray[np.intp]:
        """Number of scored samples of each joint, at least 1, int array [N]."""
        return np.asarray(np.maximum(self.motion.scored.sum(axis=0), 1))

    @property
    def unknowns(self) -> int:
        """Number of base parameters and of parameters of the causes."""
        return self.base.count + sum(cause.count for cause in self.causes)

    def with_models(self, models: Sequence[Model]) -> Balance:
        """The balance with other friction."""
        return replace(self, models=tuple(models))

    @cached_property
    def columns(self) -> Array:
        """Columns of base parameters and of the causes, array [n, N, b]."""
        if not self.causes:
            return self.rigid.values
        return np.concatenate([self.rigid.values, *(c.columns for c in self.causes)], axis=2)

    @cached_property
    def filtered_columns(self) -> tuple[Array, ...]:
        """`columns` of each joint after the low-pass, at its scored samples."""
        if not self.causes:
            return self.rigid.filtered
        parts = [self.rigid.filtered, *(c.filtered for c in self.causes)]
        return tuple(np.concatenate(of_joint, axis=1) for of_joint in zip(*parts, strict=True))

    def _passed(self, values: Array, joint: int) -> Array:
        return self.motion.filtered(values, joint)[self.motion.scored[:, joint]]

    @cached_property
    def group(self) -> NDArray[np.intp]:
        """What each sample is held out with, int array [n]: its run, or a block.

        The payload is held out by blocks: without its runs it could not be identified.
        """
        first = self.motion.joints[0]
        groups = first.run if self.held_out == "runs" else first.block
        return np.asarray(groups, dtype=np.intp)

    @property
    def held_out(self) -> str:
        """``"runs"`` or ``"blocks"``."""
        several = len(self.run_names) > 1
        carried = any(cause.runs for cause in self.causes)
        return "runs" if several and not (carried or self.by_block) else "blocks"

    @cached_property
    def cell(self) -> NDArray[np.uint32]:
        """Cell of each sample, int array [n]."""
        group, size = self.group, self.motion.rows
        part = np.arange(size) * CELLS // size
        key = group * CELLS + part
        return np.unique(key, return_inverse=True)[1].astype(np.uint32)

    @cached_property
    def group_of_cell(self) -> NDArray[np.intp]:
        """What each cell is held out with, int array [cells]."""
        made = np.zeros(int(self.cell.max()) + 1, dtype=np.intp)
        made[self.cell] = self.group
        return made

    def load(self, base: Array) -> Array:
        """Torques of the rigid bodies, array [n, N]."""
        return np.asarray(self.columns @ base)

    def problem(self, joint: int, load: Array) -> Problem:
        """The friction of a joint under a load [n]; every sample is a row."""
        recording = self.motion.with_load(joint, load)
        return Problem(recording, self.models[joint], np.arange(self.motion.rows))

    def residual(self, values: Values, joint: int) -> Array:
        """Measured minus modelled torque of every sample, array [n]."""
        load = self.load(values.base)[:, joint]
        return self.problem(joint, load).residual(values.friction[joint])

    def is_linear(self, joint: int) -> bool:
        """Whether the torque of a joint is linear in all parameters."""
        model = self.models[joint]
        reads_load = "load_torque" in model.core.needs
        return model.memoryless and not reads_load and all(p.linear for p in model.parameters)

    def factors(
        self, values: Values, joints: Sequence[int] | None = None, *, filtered: bool = True
    ) -> list[Factors]:
        """The balance of some joints, by default of every joint, linearised at `values`."""
        cells = int(self.cell.max()) + 1
        made = []
        for joint in range(len(self.models)) if joints is None else joints:
            jacobian, residual = self.linearised(values, joint, filtered=filtered)
            cell = self.cell[self.motion.scored[:, joint]]
            made.append(Factors(_core.triangle(jacobian, residual, cell, cells)))
        return made

    def linearised(
        self, values: Values, joint: int, *, filtered: bool = True
    ) -> tuple[Array, Array]:
        """``J`` [m, b + p_j] and ``r`` [m] of one joint at its m scored samples."""
        load = np.asarray(self.columns[:, joint] @ values.base)
        friction = values.friction[joint]
        residual, by_friction = self.problem(joint, load).linearise(friction)
        slope = self._by_load(joint, load, friction)
        scored = self.motion.scored[:, joint]
        if filtered:
            made = self._passed(np.column_stack([by_friction, residual]), joint)
            by_friction, residual = made[:, :-1], made[:, -1]
            by_base = (
                self.filtered_columns[joint]
                if slope is None
                else self._passed(self.columns[:, joint] * (1.0 + slope[:, None]), joint)
            )
        else:
            grown = 1.0 if slope is None else 1.0 + slope[scored, None]
            by_friction, residual = by_friction[scored], residual[scored]
            by_base = self.columns[scored, joint] * grown
        return np.ascontiguousarray(np.concatenate([by_base, by_friction], axis=1)), residual

    def _by_load(self, joint: int, load: Array, friction: Array) -> Array | None:
        """Derivative of friction by the load, array [n]; None where it does not depend on it."""
        if "load_torque" not in self.models[joint].core.needs:
            return None
        h = LOAD_STEP * max(float(np.sqrt(np.mean(load**2))), 1e-9)
        up = self.problem(joint, load + h).predict(friction)
        down = self.problem(joint, load - h).predict(friction)
        return (up - down) / (2.0 * h) - 1.0

    def bounds(self) -> tuple[Array, Array]:
        """Bounds of all values, arrays [b + sum p_j]; base parameters have none."""
        free = np.full(self.unknowns, np.inf)
        low, high = [-free], [free]
        for joint, model in enumerate(self.models):
            lower, upper, _ = bounds(model, self.motion.joints[joint])
            low.append(lower)
            high.append(upper)
        return np.concatenate(low), np.concatenate(high)

    def torque_size(self, joint: int) -> float:
        """RMS of a joint's filtered torque at its scored samples."""
        torque = self.motion.filtered(self.motion.torque[:, joint])
        return float(np.sqrt(np.mean(torque[self.motion.scored[:, joint]] ** 2)))


def places(models: Sequence[int], base: int) -> list[NDArray[np.intp]]:
    """Where the local columns of each joint stand among all, from its number of parameters."""
    starts = base + np.concatenate([[0], np.cumsum(models)])
    own = [np.arange(a, b) for a, b in itertools.pairwise(starts)]
    return [np.concatenate([np.arange(base), part]) for part in own]

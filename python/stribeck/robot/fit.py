"""Identify the rigid bodies of a robot and the friction of every joint together."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from stribeck.base.errors import FitError, joint_called, listed, nearest, option
from stribeck.base.pool import serial_linear_algebra
from stribeck.fitting.fit import fit
from stribeck.identify.scaling import bounds, model_for
from stribeck.models.model import Model
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.columns import RigidColumns
from stribeck.robot.columns import payload as payload_in
from stribeck.robot.consistent import consistent_bodies
from stribeck.robot.drive_gains import KnownPayload, drive_gains
from stribeck.robot.estimates import base_estimates, joint_fits, payload_of
from stribeck.robot.motion import RobotMotion
from stribeck.robot.problem import Balance, Values
from stribeck.robot.result import Evaluated, RobotFit
from stribeck.robot.solve import Solved, solve

#: The ordinary model of every joint: Coulomb and viscous friction, and a constant.
ORDINARY = "coulomb+offset"


class InPasses(Protocol):
    """Recordings of a robot that are read in passes: see `stribeck.stream_robot`."""

    @property
    def motion(self) -> RobotMotion:
        """The part in memory."""
        ...

    @property
    def cutoff(self) -> float:
        """Of the low-pass that both sides of the torque balance pass, Hz."""
        ...

    def balance(self, payload: Sequence[str]) -> Balance:
        """The torque balance of all samples, without friction."""
        ...


@serial_linear_algebra
def fit_robot(
    motion: RobotMotion | InPasses,
    spec: str = ORDINARY,
    *,
    of_joints: Mapping[str, str] | None = None,
    payload: Sequence[str] = (),
    known_payload: KnownPayload | None = None,
    evaluate: Sequence[RobotMotion] = (),
    starts: int = 20,
    seed: int = 0,
) -> RobotFit:
    """Identify base parameters and friction by weighted least squares.

    Parameters
    ----------
    motion
        Of `stribeck.robot.read_motion`, or of `stribeck.stream_robot` for recordings that are
        larger than memory.
    spec
        ``LAW[+effect...]`` of every joint. The load that effects read is the torque of the rigid
        bodies.
    of_joints : mapping
        Other specs, by name of the joint.
    payload : sequence of str
        Runs in which the last link carries one payload of unknown inertia.
    known_payload : KnownPayload, optional
        What the payload of these runs was: the gain of each drive follows.
    evaluate : sequence of RobotMotion
        Motions on which the result is scored, and nothing is chosen.
    starts, seed
        Random starts of the nonlinear parameters of each joint, and their seed.

    Raises
    ------
    FitError
        A joint or run that does not exist; a joint that does not move; a known payload without its
        runs.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from stribeck.recording.stated.options import ReadOptions
    >>> import numpy as np
    >>> from stribeck import model, robot
    >>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, -0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]] * 2))
    >>> friction = {
    ...     name: model("coulomb", coulomb_friction=2.0, viscous_friction=1.0) for name in arm.names
    ... }
    >>> run = robot.simulate_robot(arm, friction, seconds=20.0, rate=100.0, noise=0.01)
    >>> columns = [f"{what}={what}_{{joint}}" for what in ("position", "velocity", "torque")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "run.parquet")
    ...     run.write_parquet(path)
    ...     motion = robot.read_motion(arm, [str(path)], ReadOptions(map=columns))
    >>> found = robot.fit_robot(motion, "coulomb")
    >>> [round(joint.model.value("coulomb_friction"), 1) for joint in found.joints]
    [2.0, 2.0]
    """
    if known_payload is not None and not payload:
        raise FitError(
            f"the known payload is in no run: name the run that carries it with {option('payload')}"
        )
    found = fit_each(
        motion,
        [spec],
        of_joints=of_joints,
        payload=payload,
        evaluate=evaluate,
        starts=starts,
        seed=seed,
    )[0]
    if known_payload is None:
        return found
    return replace(found, drive_gains=drive_gains(found.solved, known_payload))


def fit_each(
    motion: RobotMotion | InPasses,
    specs: Sequence[str],
    *,
    of_joints: Mapping[str, str] | None,
    payload: Sequence[str],
    evaluate: Sequence[RobotMotion],
    starts: int,
    seed: int,
) -> tuple[RobotFit, ...]:
    """The robot with each of `specs` on all joints; the ordinary model is identified once."""
    began = time.perf_counter()
    part = in_memory(motion)
    of_each = [specs_of(part, spec, of_joints or {}) for spec in specs]
    ordinary = solve_ordinary(balance_of(motion, payload))
    made = []
    for chosen in of_each:
        solved = solve_specs(ordinary, chosen, starts=starts, seed=seed)
        made.append(result_of(solved, ordinary, evaluate, time.perf_counter() - began))
        began = time.perf_counter()
    return tuple(made)


def in_memory(motion: RobotMotion | InPasses) -> RobotMotion:
    """The motion, or the part of it that is in memory."""
    return motion if isinstance(motion, RobotMotion) else motion.motion


def balance_of(motion: RobotMotion | InPasses, payload: Sequence[str]) -> Balance:
    """The torque balance of a motion, without friction."""
    if not isinstance(motion, RobotMotion):
        return motion.balance(payload)
    check_runs(motion, payload)
    rigid = RigidColumns(motion, BaseParameters.of(motion.robot))
    return Balance(rigid, (), (payload_in(motion, tuple(payload)),) if payload else ())


def solve_ordinary(empty: Balance) -> Solved:
    """The ordinary model of every joint, from zero."""
    motion = empty.motion
    nothing = np.zeros(motion.rows)
    models, friction = [], []
    for joint in range(len(motion.joints)):
        recording = motion.with_load(joint, nothing)
        models.append(model_for(ORDINARY, recording))
        lower, upper, _ = bounds(models[-1], recording)
        friction.append(np.clip(0.0, lower, upper))
    values = Values(np.zeros(empty.unknowns), tuple(friction))
    return solve(empty.with_models(models), values)


def solve_specs(
    ordinary: Solved, specs: Sequence[str | Model], *, starts: int, seed: int
) -> Solved:
    """Given laws on all joints, from the ordinary ones."""
    if all(chosen == ORDINARY for chosen in specs):
        return ordinary
    return _solve_laws(specs, ordinary, starts=starts, seed=seed)


def _solve_laws(specs: Sequence[str | Model], near: Solved, *, starts: int, seed: int) -> Solved:
    """Each law alone under the load of `near`, then all together."""
    motion = near.balance.motion
    load = near.balance.load(near.values.base)
    models, friction = [], []
    for joint, spec in enumerate(specs):
        if spec == near.balance.models[joint].spec:
            models.append(near.balance.models[joint])
            friction.append(near.values.friction[joint])
            continue
        alone = fit(spec, motion.with_load(joint, load[:, joint]), starts=starts, seed=seed)
        models.append(alone.model)
        friction.append(np.asarray(alone.model.values, dtype=np.float64))
    values = Values(near.values.base, tuple(friction))
    return solve(near.balance.with_models(models), values, near.weights)


def result_of(
    solved: Solved, ordinary: Solved, evaluate: Sequence[RobotMotion], seconds: float
) -> RobotFit:
    """The result of a solution, and of the ordinary model beside it."""
    errors = base_estimates(solved)
    return RobotFit(
        solved=solved,
        joints=joint_fits(solved, errors),
        ordinary=joint_fits(ordinary, base_estimates(ordinary)),
        base_parameters=errors.base,
        payload=payload_of(solved, errors),
        bodies=consistent_bodies(solved, errors),
        evaluated=tuple(scored_on(solved, ordinary, motion) for motion in evaluate),
        seconds=seconds,
    )


def scored_on(solved: Solved, ordinary: Solved, motion: RobotMotion) -> Evaluated:
    """Errors on another motion, on which nothing is fitted."""
    mine = set(solved.balance.hashes)
    if not mine.isdisjoint(motion.joints[0].hashes):
        raise FitError(
            f"{motion.path}: the robot is fitted to it, so that its error there judges nothing: "
            f"give another recording with {option('evaluate')}"
        )
    rmse, relative = _errors(solved, motion)
    return Evaluated(motion.path, rmse, relative, _errors(ordinary, motion)[1])


def _errors(solved: Solved, motion: RobotMotion) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """RMSE of every joint as recorded, and relative error after the low-pass."""
    base = solved.balance.base
    balance = Balance(RigidColumns(motion, base), solved.balance.models)
    values = Values(solved.values.base[: base.count], solved.values.friction)
    rows = balance.scored_rows
    every = np.ones(balance.group_of_cell.size, dtype=bool)

    def sizes(*, filtered: bool) -> list[float]:
        factors = balance.factors(values, filtered=filtered)
        pairs = zip(factors, rows, strict=True)
        return [float(np.sqrt(joint.square(every) / count)) for joint, count in pairs]

    left = sizes(filtered=True)
    relative = tuple(size / balance.torque_size(j) for j, size in enumerate(left))
    return tuple(sizes(filtered=False)), relative


def specs_of(motion: RobotMotion, spec: str, of_joints: Mapping[str, str]) -> list[str]:
    names = motion.robot.names
    for name in of_joints:
        if name not in names:
            hint = nearest(name, names) or f"; the joints are {listed(names)}"
            raise FitError(f"{motion.robot.name} has no joint '{name}'{hint}")
    return [of_joints.get(name, spec) for name in names]


def check_runs(motion: RobotMotion, payload: Sequence[str]) -> None:
    for name, moving in zip(motion.robot.names, motion.scored.T, strict=True):
        if not moving.any():
            raise FitError(
                f"{motion.path}: {joint_called(name)} does not move, so its friction "
                f"cannot be identified: record a motion of all joints"
            )
    runs = motion.joints[0].run_names
    for run in payload:
        if run not in runs:
            hint = nearest(run, runs) or f"; the runs are {listed(runs)}"
            raise FitError(f"{motion.path} has no run '{run}'{hint}")
    if payload and len(set(payload)) == len(runs):
        raise FitError(
            f"{motion.path}: every run has the payload, which cannot be told from the last link: "
            f"add a run without it"
        )

"""Find what every joint lacks, under the load of rigid bodies identified with it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stribeck.base.errors import FitError, joint_called
from stribeck.base.pool import serial_linear_algebra
from stribeck.base.shown import Shown
from stribeck.diagnosis.diagnose import diagnose
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.plausibility.rules import DEMOTED
from stribeck.diagnosis.plausibility.shape import shape_at_end
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.fitting.fit import fit
from stribeck.robot.causes import Found, chance, rigid_causes
from stribeck.robot.consistent import consistent_bodies
from stribeck.robot.estimates import Scores, base_estimates, joint_fits
from stribeck.robot.fit import (
    ORDINARY,
    InPasses,
    balance_of,
    in_memory,
    result_of,
    solve_ordinary,
    solve_specs,
    specs_of,
)
from stribeck.robot.motion import RobotMotion
from stribeck.robot.problem import Balance, Values
from stribeck.robot.result import JointFit, RobotFit
from stribeck.robot.solve import QUICK, Solved, solve

#: Effects that identified rigid bodies hold or imitate: a load torque of another size or shape.
ABSORBED = ("gain", "gravity", "inertia", "quadrant", "spring")
#: Effects added to one joint at most.
MOST_STEPS = 4
#: Findings of a joint that are tried with the whole robot, best first.
MOST_TRIED = 3
#: Largest probability that noise lowers the held-out error of the joint so much.
SIGNIFICANCE = 0.01


@dataclass(frozen=True)
class RobotStep:
    """An effect added to the friction of one joint, all joints identified again."""

    finding: Finding
    before: JointFit
    after: JointFit

    def to_dict(self) -> dict[str, object]:
        """The JSON of one step."""
        return {
            **self.finding.to_dict(),
            "rmse_before": self.before.rmse,
            "rmse_after": self.after.rmse,
            "rmse_held_out_before": self.before.rmse_held_out,
            "rmse_held_out_after": self.after.rmse_held_out,
            "relative_residual_before": self.before.relative_residual_held_out,
            "relative_residual_after": self.after.relative_residual_held_out,
            "parameters": {name: e.to_dict() for name, e in self.after.estimates.items()},
        }


@dataclass(frozen=True, repr=False)
class RobotImprovement(Shown):
    """What every joint of a robot lacked, and the robot with it.

    Attributes
    ----------
    steps
        By name of the joint, in the order of adding.
    last
        The last diagnosis of each joint, by name.
    rigid_body
        Causes in the rigid bodies; a payload is identified with the robot, others are named.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> law = {"stribeck_height": 1.0, "stribeck_velocity": 0.2, "stribeck_exponent": 1.0}
    >>> law = model("coulomb+stribeck", coulomb_friction=2.0, viscous_friction=1.0, **law)
    >>> run = robot.simulate_robot(arm, {"1": law}, seconds=10.0, rate=50.0, noise=0.01)
    >>> motion = robot.RobotMotion.of(arm, [read(run)])
    >>> found = robot.improve_robot(motion, "coulomb", starts=1, most_steps=1)
    >>> [step.finding.effect for step in found.steps["1"]], found.final.joints[0].model.spec
    (['stribeck'], 'coulomb+stribeck')
    """

    base: RobotFit
    final: RobotFit
    steps: Mapping[str, tuple[RobotStep, ...]]
    last: Mapping[str, Diagnosis]
    rigid_body: tuple[Found, ...]

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot improve`."""
        final = self.final.to_dict()
        rows = [
            {
                "joint": joint.joint,
                "steps": [step.to_dict() for step in self.steps.get(joint.joint, ())],
                "final": joint.to_dict(),
                "verdict": self.last[joint.joint].verdict,
                "untestable": [row.to_dict() for row in self.last[joint.joint].untestable],
            }
            for joint in self.final.joints
        ]
        kept = ("robot", "base_parameters", "consistent", "payload", "ordinary", "evaluated")
        return {
            "joints": rows,
            "rigid_body": [found.to_dict() for found in self.rigid_body],
            **{key: final[key] for key in (*kept, "cutoff_hz", "held_out", "seconds")},
        }


@serial_linear_algebra
def improve_robot(
    motion: RobotMotion | InPasses,
    spec: str = ORDINARY,
    *,
    of_joints: Mapping[str, str] | None = None,
    payload: Sequence[str] = (),
    evaluate: Sequence[RobotMotion] = (),
    starts: int = 20,
    seed: int = 0,
    least_fall: float = LEAST_FALL,
    most_steps: int = MOST_STEPS,
    progress: Callable[[str], None] = lambda sentence: None,
) -> RobotImprovement:
    """Add to each joint the effects that it lacks.

    An effect is sought in each joint by `stribeck.diagnose`, under the load torque of the rigid
    bodies just identified. It is added if, with all joints identified again, the held-out error of
    its joint falls by at least `least_fall`, significantly, and that of all joints together falls.
    A payload in some runs is sought first. In recordings that are read in passes, effects are
    sought in the part in memory; the models without and with them are then identified on all
    samples.

    Parameters
    ----------
    most_steps
        Effects added to one joint at most; 0: only a diagnosis.
    progress
        Called with one sentence at each step.

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
    >>> found = robot.improve_robot(motion, "coulomb", most_steps=1)
    >>> {name: len(steps) for name, steps in found.steps.items()}
    {'1': 0, '2': 0}
    """
    began = time.perf_counter()
    part = in_memory(motion)
    specs = specs_of(part, spec, of_joints or {})
    empty = balance_of(part, payload)
    progress("identifying the rigid bodies")
    ordinary = solve_ordinary(empty)
    start = solve_specs(ordinary, specs, starts=starts, seed=seed)
    progress("looking for causes in the rigid bodies")
    found, start = _with_payload(start, least_fall)
    if found and found[0].cause.runs:
        ordinary = solve_ordinary(replace(empty, causes=start.balance.causes))
    search = _Search(start, seed, least_fall, most_steps, progress)
    search.run()
    final = search.solved
    if not isinstance(motion, RobotMotion):
        progress("identifying the models on all samples")
        empty = replace(motion.balance(()), causes=final.balance.causes)
        anew = {id(solved): solved for solved in (ordinary, start, final)}
        anew = {key: _again(solved, empty) for key, solved in anew.items()}
        ordinary, start, final = (anew[id(solved)] for solved in (ordinary, start, final))
    seconds = time.perf_counter() - began
    return RobotImprovement(
        base=result_of(start, ordinary, (), seconds),
        final=result_of(final, ordinary, evaluate, seconds),
        steps={name: tuple(steps) for name, steps in search.steps.items()},
        last=search.last,
        rigid_body=tuple(found),
    )


def _again(solved: Solved, empty: Balance) -> Solved:
    """The same models on other samples."""
    return solve(empty.with_models(solved.balance.models), solved.values, solved.weights)


def _with_payload(solved: Solved, least_fall: float) -> tuple[list[Found], Solved]:
    """Causes in the rigid bodies; the solution with a payload, where that is the best of them."""
    bodies = consistent_bodies(solved, base_estimates(solved))
    found = rigid_causes(solved, bodies.parameters, least_fall)
    if not found or not found[0].cause.runs:
        return found, solved
    carried = found[0].solved
    others = rigid_causes(carried, bodies.parameters, least_fall)
    return [found[0], *others], carried


class _Search:
    """The search for effects, joint by joint."""

    def __init__(
        self,
        start: Solved,
        seed: int,
        least_fall: float,
        most_steps: int,
        progress: Callable[[str], None],
    ) -> None:
        self.solved = start
        self.scores = Scores.of(start, raw=False)
        self.seed, self.least_fall, self.most_steps = seed, least_fall, most_steps
        self.progress = progress
        self.names = start.balance.motion.robot.names
        self.steps: dict[str, list[RobotStep]] = {name: [] for name in self.names}
        self.last: dict[str, Diagnosis] = {}

    def run(self) -> None:
        """Add effects to one joint after the other."""
        for joint, name in enumerate(self.names):
            more = True
            while more:
                self.progress(f"{joint_called(name)}: {self.solved.balance.models[joint].spec}")
                self.last[name] = self._diagnosed(joint)
                more = len(self.steps[name]) < self.most_steps and self._added(joint)

    def _diagnosed(self, joint: int) -> Diagnosis:
        balance = self.solved.balance
        load = balance.load(self.solved.values.base)[:, joint]
        recording = balance.motion.with_load(joint, load)
        model = balance.models[joint].with_values(self.solved.values.friction[joint])
        alone = fit(model, recording, starts=1, seed=self.seed)
        return diagnose(alone, least_fall=self.least_fall, seed=self.seed, rejected=ABSORBED)

    def _added(self, joint: int) -> bool:
        """Add the best finding that holds with the whole robot, if there is one."""
        name = self.names[joint]
        for finding in self.last[name].findings[:MOST_TRIED]:
            try:
                trial = self._with(joint, finding)
            except FitError:
                # Its law is not defined where the rigid bodies move the load to.
                continue
            scores = Scores.of(trial, raw=False)
            if self._holds(joint, trial, scores):
                trial = solve(trial.balance, trial.values, trial.weights)
                before = joint_fits(self.solved, base_estimates(self.solved))[joint]
                after = joint_fits(trial, base_estimates(trial))[joint]
                # Below the cut-off the error falls; as measured it must not rise.
                if after.rmse_held_out >= before.rmse_held_out:
                    continue
                scores = Scores.of(trial, raw=False)
                self.steps[name].append(
                    RobotStep(_in_doubt_at_bound(finding, after), before, after)
                )
                self.solved, self.scores = trial, scores
                self.progress(f"{joint_called(name)}: added {finding.effect}")
                return True
        return False

    def _with(self, joint: int, finding: Finding) -> Solved:
        balance, values = self.solved.balance, self.solved.values
        model = finding.fit.model
        models = (*balance.models[:joint], model, *balance.models[joint + 1 :])
        own = np.asarray(model.values, dtype=np.float64)
        friction = (*values.friction[:joint], own, *values.friction[joint + 1 :])
        start = Values(values.base, friction)
        return solve(replace(balance, models=models), start, self.solved.weights, QUICK)

    def _holds(self, joint: int, trial: Solved, scores: Scores) -> bool:
        """Whether the held-out errors of the joint, and of all together, fall."""
        before = self.scores
        falls = (
            scores.filtered_held_out[joint]
            <= (1.0 - self.least_fall) * (before.filtered_held_out[joint])
        )
        weights = self.solved.weights[:, None] ** 2
        whole = np.sum(weights * scores.cells) <= np.sum(weights * before.cells)
        return bool(
            falls and whole and chance(before.cells[joint], scores.cells[joint]) < SIGNIFICANCE
        )


def _in_doubt_at_bound(finding: Finding, joint: JointFit) -> Finding:
    """A finding, as likely as not where its shape ends at a bound with all joints identified."""
    if not shape_at_end(finding.effect, joint.estimates):
        return finding
    return replace(finding, weight=min(finding.weight, DEMOTED))

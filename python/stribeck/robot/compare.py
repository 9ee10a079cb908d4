"""Several models of all joints on one motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import polars as pl

from stribeck.base.shown import Shown
from stribeck.robot.fit import ORDINARY, InPasses, fit_each
from stribeck.robot.motion import RobotMotion
from stribeck.robot.result import RobotFit


@dataclass(frozen=True, repr=False)
class RobotComparison(Shown):
    """The errors of several models of all joints, in the order given.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> law = {"coulomb_friction": 2.0, "viscous_friction": 1.0, "offset": 0.5}
    >>> friction = {"1": model("coulomb+offset", **law)}
    >>> run = robot.simulate_robot(arm, friction, seconds=20.0, rate=100.0, noise=0.01)
    >>> motion = robot.RobotMotion.of(arm, [read(run)])
    >>> found = robot.compare_robots(motion, ["coulomb", "coulomb+offset"]).to_frame()
    >>> found.sort("rmse_held_out")["model"][0]
    'coulomb+offset'
    """

    fits: tuple[RobotFit, ...]
    specs: tuple[str, ...]

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot compare`."""
        rows = [
            {
                "model": spec,
                "joints": [
                    {
                        "joint": joint.joint,
                        "rmse": joint.rmse,
                        "rmse_held_out": joint.rmse_held_out,
                        "relative_residual": joint.relative_residual_held_out,
                    }
                    for joint in found.joints
                ],
                "consistent": found.consistent,
                "evaluated": [row.to_dict() for row in found.evaluated],
            }
            for spec, found in zip(self.specs, self.fits, strict=True)
        ]
        return {"models": rows, "cutoff_hz": self.fits[0].solved.balance.motion.cutoff}

    def to_frame(self) -> pl.DataFrame:
        """One row per model and joint."""
        pairs = zip(self.specs, self.fits, strict=True)
        return pl.concat(
            found.to_frame().with_columns(pl.lit(spec).alias("model")) for spec, found in pairs
        )


def compare_robots(
    motion: RobotMotion | InPasses,
    specs: Sequence[str] = (ORDINARY,),
    *,
    of_joints: Mapping[str, str] | None = None,
    payload: Sequence[str] = (),
    evaluate: Sequence[RobotMotion] = (),
    starts: int = 20,
    seed: int = 0,
) -> RobotComparison:
    """Identify the robot with each of `specs` on all joints; arguments as of `fit_robot`.

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
    >>> robot.compare_robots(motion, ["coulomb", "coulomb+offset"]).specs
    ('coulomb', 'coulomb+offset')
    """
    fits = fit_each(
        motion,
        specs,
        of_joints=of_joints,
        payload=payload,
        evaluate=evaluate,
        starts=starts,
        seed=seed,
    )
    return RobotComparison(fits, tuple(specs))

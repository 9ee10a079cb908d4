"""`stream_robot`: recordings of a robot that are larger than memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.recording.motion.excerpt import SAMPLE_ROWS
from stribeck.recording.stated.options import ReadArguments, ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.fit import balance_of
from stribeck.robot.motion import RobotMotion
from stribeck.scale.robots.balance import StreamedBalance
from stribeck.scale.robots.data import RobotData
from stribeck.scale.streaming.passes import Told

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["RobotStream", "stream_robot"]


def _silent(done: int, total: int, number: int) -> None:
    """Report no progress."""


@dataclass(frozen=True, repr=False)
class RobotStream:
    """Recordings of all joints of a robot, of which only a part is in memory.

    `stribeck.robot.fit_robot`, `compare_robots` and `improve_robot` take it in place of a motion.

    Attributes
    ----------
    data
        The files, and contiguous parts of them.

    Examples
    --------
    >>> import numpy as np, tempfile
    >>> from stribeck import robot, stream_robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> columns = [f"{what}={what}_{{joint}}" for what in ("position", "velocity", "torque")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     run = robot.simulate_robot(arm, {}, seconds=20.0, rate=100.0)
    ...     run.write_parquet(f"{folder}/run.parquet")
    ...     opened = stream_robot(arm, [f"{folder}/run.parquet"], map=columns, sample_rows=400)
    ...     run.height, opened.motion.rows
    (2000, 400)
    """

    data: RobotData

    def __repr__(self) -> str:
        return f"<RobotStream with {self.motion!r} in memory>"

    @property
    def motion(self) -> RobotMotion:
        """The motion and torques of all joints in the part in memory."""
        return self.data.motion

    @property
    def cutoff(self) -> float:
        """Of the low-pass that both sides of the torque balance pass, Hz."""
        return self.data.motion.cutoff

    def balance(self, payload: Sequence[str]) -> StreamedBalance:
        """The torque balance of all samples, without friction."""
        part = balance_of(self.data.motion, payload)
        return StreamedBalance(part.rigid, part.models, part.causes, data=self.data)


def stream_robot(
    robot: Robot,
    files: Sequence[str | Path],
    *,
    cutoff: float | None = None,
    sample_rows: int = SAMPLE_ROWS,
    seed: int = 0,
    told: Told = _silent,
    **reading: Unpack[ReadArguments],
) -> RobotStream:
    """Open recordings of a robot in Parquet or CSV files that are larger than memory.

    Parameters
    ----------
    files
        Several are runs of one robot, each named as its file.
    cutoff
        Of the low-pass on both sides of the torque balance, Hz; default: ten times the bandwidth of
        the motion.
    sample_rows
        Samples in memory, in stretches spread over longer files. Which samples move, the bounds and
        starts of the parameters, and the cut-off are found on them. With all samples in memory,
        results are those of `stribeck.robot.fit_robot` but for rounding.
    seed
        Of the places of the stretches.
    told
        Called after each window with the samples done, all samples, and the number of the pass.
    **reading
        Options of `stribeck.read`, except `average`, `drive`, `hold_out`, `unwrap` and `weights`.

    Raises
    ------
    RecordingError
        A file or an option cannot be used.

    Examples
    --------
    >>> import numpy as np, tempfile
    >>> from stribeck import model, robot, stream_robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> friction = {"1": model("coulomb", coulomb_friction=2.0, viscous_friction=1.0)}
    >>> columns = [f"{what}={what}_{{joint}}" for what in ("position", "velocity", "torque")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     run = robot.simulate_robot(arm, friction, seconds=20.0, rate=100.0, noise=0.01)
    ...     run.write_parquet(f"{folder}/run.parquet")
    ...     opened = stream_robot(arm, [f"{folder}/run.parquet"], map=columns)
    ...     robot.fit_robot(opened, "coulomb").joints[0].model.values.round(1)
    array([1., 2.])
    """
    data = RobotData.open(
        robot,
        [str(file) for file in files],
        ReadOptions.of(reading),
        cutoff=cutoff,
        sample_rows=sample_rows,
        seed=seed,
        told=told,
    )
    return RobotStream(data)

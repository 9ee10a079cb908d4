"""The joints of a robot in a data set that is larger than memory."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, option
from stribeck.identify.scaling import model_for
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.several.paths import listed_files, run_names, text_of
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.stated.settings import Settings, gather
from stribeck.robot.arm import Robot
from stribeck.robot.fit import ORDINARY
from stribeck.robot.motion import BEFORE, RobotMotion, default_cutoff, joint_options
from stribeck.scale.robots.band import motion_band
from stribeck.scale.robots.text_parts import TEXT, text_parts
from stribeck.scale.streaming.dataset import SUFFIXES, DataSet
from stribeck.scale.streaming.margin import PERIODS, Margin
from stribeck.scale.streaming.passes import Told
from stribeck.scale.streaming.sample import Sample, take
from stribeck.scale.streaming.windows import Window, Windows

__all__ = ["RobotData", "RobotWindow"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

#: Samples of a window: the columns of a seven-joint arm then take a few hundred MB.
WINDOW_ROWS = 50_000


@dataclass(frozen=True)
class RobotWindow:
    """A stretch of the data set with margins.

    Attributes
    ----------
    own
        Which samples are those of the window without margins, bool array [n].
    row
        Index in the data set of each sample, array [n].
    """

    motion: RobotMotion
    own: Bools
    row: Ints


@dataclass(frozen=True)
class Totals:
    """Sums over all samples: of scored samples, and of their filtered torques, by joint.

    Attributes
    ----------
    scored : int array [N]
    torque_square : array [N]
    """

    scored: NDArray[np.intp]
    torque_square: Array


@dataclass(eq=False)
class RobotData:
    """All joints of a data set, of which only a window and a sample are in memory.

    Attributes
    ----------
    joints
        The sample of each joint, and how its other samples are read.
    motion
        The motion of all joints in the sample.
    told
        Called after each window with the samples done, all samples, and the number of the pass.
    passes
        How often all samples have been read.
    """

    robot: Robot
    data: DataSet
    joints: tuple[Sample, ...]
    motion: RobotMotion
    told: Told
    window_rows: int = WINDOW_ROWS
    passes: int = 0
    scratch: TemporaryDirectory[str] | None = field(default=None, repr=False)

    @classmethod
    def open(
        cls,
        robot: Robot,
        files: Sequence[str],
        reading: ReadOptions,
        *,
        cutoff: float | None,
        sample_rows: int,
        seed: int,
        told: Told,
    ) -> RobotData:
        """Find the joints of Parquet and text files; several files are runs.

        Text is written as Parquet into a temporary folder first.

        Raises
        ------
        RecordingError
            A file cannot be read in passes, or the joints cannot be found in it.
        """
        listed = listed_files(list(files))
        options = joint_options(robot, reading)
        settings = [_shared(listed, own) for own in options]
        scratch = TemporaryDirectory(prefix="stribeck-") if _has_text(listed) else None
        data = _opened(listed, settings[0], scratch)
        joints = tuple(take(data, own, sample_rows, seed) for own in settings)
        if any(sample.joint is not None for sample in joints):
            raise RecordingError(
                f"{data.path}: joints that stand below each other are not read in passes: write "
                f"each joint's channels as columns of their own, and name them with {option('map')}"
            )
        named = [
            replace(sample.recording, joint=joint.name, sha256=data.sha256)
            for sample, joint in zip(joints, robot.joints, strict=True)
        ]
        if cutoff is None and not joints[0].whole:
            bands = [motion_band(data, sample) for sample in joints]
            cutoff = default_cutoff(bands, named[0].rate_hz)
        motion = RobotMotion.of(robot, named, cutoff)
        return cls(robot, data, joints, motion, told, scratch=scratch)

    @cached_property
    def run_names(self) -> tuple[str, ...]:
        """Names of the runs, in order."""
        first = self.joints[0]
        if self.data.runs:
            return tuple(dict.fromkeys(self.data.runs))
        choice = first.prepared.choices.get("run")
        if choice is None or choice.source not in self.data.schema:
            if first.starts.size == 1:
                return first.recording.run_names
            return tuple(str(k + 1) for k in range(first.starts.size))
        names = [self.data.frame(row, row + 1, [choice.source]).item() for row in first.starts]
        return tuple(map(str, names))

    def windows(self, models: Sequence[Model]) -> Iterator[RobotWindow]:
        """All samples in order, with what the `models` of the joints need."""
        self.passes += 1
        number = self.passes
        least = self._margin(models)
        joints = [
            iter(Windows(self.data, sample, model, self.window_rows, least))
            for sample, model in zip(self.joints, models, strict=True)
        ]
        for windows in itertools.zip_longest(*joints):
            made = self._joined(windows)
            yield made
            self.told(int(made.row[made.own][-1]) + 1, self.data.rows, number)

    def _margin(self, models: Sequence[Model]) -> Margin:
        """The margin of all joints: of what they need, and of the filters of the balance."""
        samples_a_period = self.motion.joints[0].rate_hz / self.motion.cutoff
        reach = int(PERIODS * (1.0 + 1.0 / BEFORE) * samples_a_period) + 1
        widest = Margin(0, 0)
        for sample, model in zip(self.joints, models, strict=True):
            widest = widest.at_least(Margin.of(model, sample.recording))
        return Margin(widest.before + reach, widest.after + reach)

    def _joined(self, windows: Sequence[Window | None]) -> RobotWindow:
        """A window of all joints."""
        made = [window for window in windows if window is not None]
        if len({window.end for window in made}) != 1 or len(made) != len(windows):
            raise RecordingError(
                f"{self.data.path}: the joints have different samples; remove rows in which a "
                f"value is missing with {option('where')}"
            )
        recordings = [
            self._named(window.recording, name)
            for window, name in zip(made, self.robot.names, strict=True)
        ]
        motion = RobotMotion.of(self.robot, recordings, self.motion.cutoff)
        return RobotWindow(motion, made[0].own, made[0].row)

    def _named(self, recording: Recording, joint: str) -> Recording:
        return replace(recording, joint=joint, run_names=self.run_names)

    @cached_property
    def totals(self) -> Totals:
        """Sums over all samples, by one pass."""
        count = len(self.robot.joints)
        scored, square = np.zeros(count, dtype=np.intp), np.zeros(count)
        for window in self.windows([model_for(ORDINARY, joint) for joint in self.motion.joints]):
            motion = window.motion
            mine = motion.scored & window.own[:, None]
            torque = motion.filtered(motion.torque)
            scored += mine.sum(axis=0)
            square += np.einsum("ij,ij->j", torque * mine, torque)
        return Totals(scored, square)


def _shared(files: Sequence[str], reading: ReadOptions) -> Settings:
    """What is known of all files; windows may lie in several, so that they cannot differ."""
    first, *others = (gather(file, reading) for file in files)
    for file, other in zip(files[1:], others, strict=True):
        if replace(other, sidecar=first.sidecar) != first:
            raise RecordingError(
                f"{file}: its sidecar says something else than that of {files[0]}: files read in "
                f"passes share one, given with {option('sidecar')}"
            )
    return first


def _has_text(files: Sequence[str]) -> bool:
    return any(file.lower().endswith(TEXT) for file in files)


def _opened(
    files: Sequence[str], settings: Settings, scratch: TemporaryDirectory[str] | None
) -> DataSet:
    """The data set of some files, with text as Parquet in the temporary folder."""
    parts: list[str] = []
    sources: list[str] = []
    for file in files:
        made = [file]
        if scratch is not None and file.lower().endswith(TEXT):
            made = text_parts(file, settings.asked, Path(scratch.name))
        elif not file.lower().endswith(SUFFIXES):
            raise RecordingError(
                f"{file}: only Parquet, CSV and TSV files are read in passes: write it as Parquet"
            )
        parts += made
        sources += [file] * len(made)
    names = dict(zip(files, run_names(files), strict=True))
    runs = [names[source] for source in sources] if len(files) > 1 else []
    return DataSet.of_files(text_of(files, files), parts, runs=runs, sources=sources)

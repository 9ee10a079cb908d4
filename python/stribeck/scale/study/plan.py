"""The fits of a study: which laws, on which joints, from how many starts."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby

import numpy as np

from stribeck.base.errors import FitError, SpecError
from stribeck.identify.scaling import model_for
from stribeck.identify.stated.choices import Choices
from stribeck.models.model import Model
from stribeck.models.spec import parse_spec
from stribeck.recording.load import read_with
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.stated.sidecar import sidecar_hash
from stribeck.recording.whole_file.scan import scan_with

#: The 25 laws of the review, in the order of its tables 1, 2 and 3.
REVIEW = (
    "bittencourt_a",
    "clochiatti",
    "coulomb",
    "dong",
    "gaz_a",
    "gaz_b",
    "grotjahn_a",
    "grotjahn_b",
    "hao_a",
    "indri_a",
    "makkar",
    "shao",
    "wolf",
    "zhou",
    "bittencourt_b",
    "hao_b",
    "iskandar",
    "li",
    "madsen",
    "nevmerzhitskiy",
    "simoni",
    "dahl",
    "indri_b",
    "lugre",
    "tadese_t",
)
#: Number of starts of each law on each joint (review, section 4).
STARTS = 20
#: Largest low speed of the tables: in rad/s as in the review, in m/s for a prismatic joint.
LOW_SPEED = {"revolute": 0.1, "prismatic": 0.01}


@dataclass(frozen=True)
class LawGroup:
    """Laws that are compared in one table."""

    id: str
    title: str


STATIC = LawGroup("static", "Static laws without temperature and load (as table 4 of the review)")
THERMAL = LawGroup("thermal", "Static laws with temperature or load (as table 5)")
DYNAMIC = LawGroup("dynamic", "Dynamic laws (as table 6)")
GROUPS = (STATIC, THERMAL, DYNAMIC)


def group_of(model: Model) -> LawGroup:
    """Return the table of a model, by the inputs of its friction."""
    if model.has_state:
        return DYNAMIC
    if {"temperature", "load_torque", "external_torque"} & set(model.core.needs):
        return THERMAL
    return STATIC


@dataclass(frozen=True)
class Job:
    """One fit: a law, a joint and a start."""

    joint: str | None
    law: str
    start: int


@dataclass(frozen=True)
class Skipped:
    """A law that cannot be fitted to the recording of a joint, and why."""

    joint: str | None
    law: str
    why: str


@dataclass(frozen=True)
class StudyPlan:
    """A study before it runs.

    Attributes
    ----------
    path, reading
        The recording and the options that read it, as `stribeck.read` takes them.
    data
        SHA-256 of the file, and of the sidecar where there is one.
    joints
        In the order of the file; ``(None,)`` if they have no names.
    laws
        Specs, in the order given.
    starts, seed
        Number of starts of each law, and the seed of the random starts.
    jobs
        Every possible fit, by joint and law, dynamic laws first. A law without nonlinear parameters
        has one start: its parameters follow from linear equations.
    skipped
        Laws that need a channel which a recording lacks.
    notes
        How the recordings were read.
    choices
        Starts, bounds and held values, for every law that has the parameter.
    """

    path: str
    reading: ReadOptions
    data: Mapping[str, str | None]
    joints: tuple[str | None, ...]
    laws: tuple[str, ...]
    starts: int
    seed: int
    jobs: tuple[Job, ...] = field(repr=False)
    skipped: tuple[Skipped, ...]
    notes: tuple[str, ...]
    choices: Choices = field(default_factory=Choices)

    def pieces(self, todo: Collection[Job]) -> list[tuple[Job, ...]]:
        """Return groups of fits: all starts of a law on a joint, if at least one is in `todo`."""
        together = groupby(self.jobs, key=lambda job: (job.joint, job.law))
        pieces = [tuple(jobs) for _, jobs in together]
        wanted = set(todo)
        return [piece for piece in pieces if not wanted.isdisjoint(piece)]

    def read(self, joint: str | None) -> Recording:
        """Read the recording of one joint."""
        return read_with(self.path, replace(self.reading, joint=joint))


def make_plan(
    path: str,
    reading: ReadOptions,
    laws: Sequence[str] = REVIEW,
    *,
    starts: int = STARTS,
    seed: int = 0,
    choices: Choices | None = None,
) -> StudyPlan:
    """Plan the fits of `laws` to each joint of a recording.

    Raises
    ------
    SpecError
        A law is unknown or given twice; the number of starts or the seed is invalid; a choice is
        about a parameter that no law has.
    RecordingError
        The recording cannot be read.
    FitError
        No law can be fitted to it.
    """
    _check(laws, starts, seed)
    choices = choices or Choices()
    made: dict[str, Model] = {}
    joints = _joints(path, reading)
    jobs: list[Job] = []
    skipped: list[Skipped] = []
    notes: list[str] = []
    sha256 = ""
    for joint in joints:
        recording = read_with(path, replace(reading, joint=joint))
        recording.require_consistent()
        sha256 = recording.sha256
        notes += recording.notes
        counts: dict[str, int] = {}
        for law in laws:
            try:
                made[law] = model_for(law, recording)
                counts[law] = _useful_starts(made[law], recording, starts)
            except FitError as error:
                skipped.append(Skipped(joint, law, str(error)))
        # The slowest fits start first, so that no worker waits for the last of them.
        in_turn = sorted(counts, key=lambda law: not made[law].has_state)
        jobs += [Job(joint, law, k) for law in in_turn for k in range(counts[law])]
    if not jobs:
        raise FitError(f"{path}: no law of the study can be fitted: {skipped[0].why}")
    choices.applied_to_each(list(made.values()))
    return StudyPlan(
        path=path,
        reading=reading,
        data={"sha256": sha256, "sidecar_sha256": sidecar_hash(path, reading.sidecar)},
        joints=joints,
        laws=tuple(laws),
        starts=starts,
        seed=seed,
        jobs=tuple(jobs),
        skipped=tuple(skipped),
        notes=tuple(dict.fromkeys(notes)),
        choices=choices,
    )


def _check(laws: Sequence[str], starts: int, seed: int) -> None:
    if not laws:
        raise SpecError("a study needs at least one law: name one")
    if starts < 1:
        raise SpecError(f"{starts} starts: give 1 or more")
    if seed < 0:
        raise SpecError(f"seed {seed} is negative: give 0 or more")
    for law in laws:
        parse_spec(law)
        if laws.count(law) > 1:
            raise SpecError(f"law {law!r} is given twice: leave one out")


def _joints(path: str, reading: ReadOptions) -> tuple[str | None, ...]:
    """Return the selected joint, or every joint of the file."""
    if reading.joint is not None:
        return (str(reading.joint),)
    return scan_with(path, reading).joints or (None,)


def _useful_starts(model: Model, recording: Recording, starts: int) -> int:
    """Return the number of starts: one for a linear model; raise FitError if data are too few."""
    fewest = len(model.names) + 2
    if int(np.count_nonzero(recording.moving)) < fewest:
        raise FitError(
            f"{recording.path} has fewer than {fewest} moving samples, which {model.spec} needs at "
            f"least"
        )
    return 1 if all(p.linear for p in model.parameters) else starts

"""What the workbench knows: files, the recording, the project, and what was asked of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from stribeck.base.errors import joint_called
from stribeck.diagnosis.compare import Comparison
from stribeck.motion.design.result import Plan
from stribeck.passivity.certificate import Certificate
from stribeck.projects.project import Project
from stribeck.projects.sides import Sides
from stribeck.recording.recording import Recording
from stribeck.recording.several.paths import text_of
from stribeck.recording.stated.options import ReadOptions
from stribeck.report.workbench.actions import Looked


@dataclass(frozen=True)
class Message:
    """One sentence for the user."""

    kind: Literal["error", "done"]
    text: str


@dataclass
class Joint:
    """One joint, and all that was done with it.

    Attributes
    ----------
    files
        One, or several that are runs of the joint.
    others
        Names of all joints of the files, where there are several.
    comparisons, certificates
        By number of the node.
    laws
        Laws compared on the recording, before or beside the project.
    """

    files: tuple[str, ...]
    options: ReadOptions = field(default_factory=ReadOptions)
    recording: Recording | None = None
    looked: Looked | None = None
    others: tuple[str, ...] = ()
    project: Project | None = None
    comparisons: dict[int, Comparison] = field(default_factory=dict)
    certificates: dict[int, Certificate] = field(default_factory=dict)
    laws: Comparison | None = None
    sides: Sides | None = None
    plan: Plan | None = None

    @property
    def comparison(self) -> Comparison | None:
        """Of the current model."""
        return None if self.project is None else self.comparisons.get(self.project.current)

    @property
    def certificate(self) -> Certificate | None:
        """Of the current model."""
        return None if self.project is None else self.certificates.get(self.project.current)

    @property
    def stem(self) -> str:
        """How the names of files begin that are written."""
        first, more = Path(self.files[0]).name.split(".")[0], len(self.files) - 1
        return f"{first}-and-{more}-more" if more else first

    @property
    def title(self) -> str:
        """The files, and the joint where one is named."""
        names = [Path(file).name for file in self.files]
        name = text_of(names, names)
        return f"{name}, {joint_called(self.options.joint)}" if self.options.joint else name


@dataclass
class State:
    """All of it.

    Attributes
    ----------
    joints
        What was worked on, the newest last.
    current
        The one that the pages show.
    message, page
        The last message, and the page that it is for; empty: every page.
    version
        Counts the changes.
    """

    files: list[str] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    current: Joint | None = None
    written: list[Path] = field(default_factory=list)
    message: Message | None = None
    page: str = ""
    version: int = 0

"""The workbench without its pages: a state, and the actions that change it."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from stribeck.base.errors import ProjectError, RecordingError, SpecError, StribeckError
from stribeck.base.files import write_bytes_whole, write_table, write_whole
from stribeck.base.lock import one_writer
from stribeck.diagnosis.compare import Comparison
from stribeck.exporters.export import Export
from stribeck.motion.design.result import Plan
from stribeck.motion.generate.files import file_bytes
from stribeck.passivity.certificate import Certificate
from stribeck.projects.project import Project
from stribeck.projects.sides import Sides
from stribeck.recording.recording import Recording
from stribeck.recording.several.paths import named_files
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.tables.readers import SUFFIXES
from stribeck.report.workbench import actions
from stribeck.report.workbench.actions import Changed, Looked, RobotPage
from stribeck.report.workbench.state import Joint, Message, State
from stribeck.report.workbench.work import Kind, Work

#: How the names of projects end.
PROJECT = ".toml"


class Workbench:
    """One user's work on recordings; every change of a project is saved at once.

    Parameters
    ----------
    folder
        Where projects, uploads and all that is exported are written; made when it is needed.
    files
        Recordings, which are opened as runs of one joint, or project files.
    spell : callable
        Writes the options in sentences.

    Notes
    -----
    Methods return at once. Long work goes on in another process, one at a time; `wait` waits for
    it. An action that cannot be done raises `StribeckError`.
    """

    def __init__(self, folder: Path, files: list[str], spell: Callable[[str], str] = str) -> None:
        self.folder = folder
        self.state = State(files=list(files))
        self.spell = spell
        self.work: Work | None = None
        self._changed = threading.Condition(threading.RLock())
        #: How long each kind of work took last, s.
        self.took: dict[str, float] = {}
        recordings = [file for file in files if not file.endswith(PROJECT)]
        if files:
            self.open(*(recordings or files[:1]))

    # Data

    def open(self, *given: str) -> None:
        """Open a recording, several files as its runs, or a project file."""
        is_project = len(given) == 1 and given[0].endswith(PROJECT)
        files = given if is_project else tuple(named_files(given))
        for path in files:
            if not os.path.isfile(path):
                raise RecordingError(f"{path}: there is no such file: check the path")
        self.state.files += [path for path in files if path not in self.state.files]
        joint = self._joint(files)
        if is_project:
            self._do(actions.reopen, files, f"Opening {Path(files[0]).name}", joint)
        else:
            self._look(joint, joint.options)

    def upload(self, sent: Sequence[tuple[str, bytes]]) -> None:
        """Keep files that were sent, each with its name, and open them."""
        names = [Path(name.replace("\\", "/")).name for name, _ in sent]
        for name in names:
            if not name.lower().removesuffix(".gz").endswith((*SUFFIXES, ".toml")):
                raise RecordingError(
                    f"{name}: this format is not read: give CSV, Parquet or MATLAB"
                )
        folder = self._made(self.folder / "uploads")
        paths = []
        for name, (_, content) in zip(names, sent, strict=True):
            paths.append(_free(folder, name))
            write_bytes_whole(paths[-1], content)
        self.open(*map(str, paths))

    def choose(self, number: int) -> None:
        """Show another of the joints that were worked on."""
        self._require_idle()
        if not 0 <= number < len(self.state.joints):
            raise SpecError(f"there is no recording {number}: reload the page")
        self.state.current = self.state.joints[number]
        self._note()

    def read(self, options: ReadOptions) -> None:
        """Read the current file with other options; another joint is work of its own."""
        joint = self.joint
        if joint.project is not None or options.joint != joint.options.joint:
            joint = Joint(joint.files, options, others=joint.others)
            self.state.joints.append(joint)
            self.state.current = joint
        self._look(joint, options)

    # The loop

    def start(self, base: str) -> None:
        """Make a project: `base` is fitted and saved."""
        joint = self.joint
        if joint.recording is None:
            raise RecordingError("there is no recording yet: complete the page Check first")
        joint.recording.require_consistent()
        if joint.project is not None:
            given = (joint.files, joint.options, joint.recording, joint.looked, joint.others)
            joint = Joint(*given)
            self.state.joints.append(joint)
        of = f"-joint-{joint.options.joint}" if joint.options.joint else ""
        path = _free(self._made(self.folder), f"{joint.stem}{of}.project.toml")
        self._do(
            actions.begin, (str(path), joint.files, base, joint.options), f"Fitting {base}", joint
        )

    def improve_robot(self, described: str) -> None:
        """Identify all joints of the files together, and add what each lacks."""
        joint = self.joint
        given = (joint.files, described, joint.options)
        self._do(actions.improve_robot, given, "Improving all joints of the robot")

    def compare_laws(self, laws: list[str]) -> None:
        """Fit several laws, and compare them."""
        if self.joint.recording is None or not laws:
            raise SpecError("there is nothing to compare: open a recording and choose laws")
        self._do(actions.compare_laws, (self.joint.recording, laws), "Comparing laws")

    def where(self) -> None:
        """Compute where the current model fails."""
        self._do(actions.where, (self.project,), "Where the model fails")

    def diagnose(self) -> None:
        """Find what the current model lacks."""
        self._do(actions.diagnose, (self.project,), "Finding what is missing")

    def add(self, effect: str) -> None:
        """Add an effect: a new model in the tree."""
        self._do(actions.add, (self.project, effect), f"Adding {effect}")

    def drop(self, effect: str) -> None:
        """Drop an effect: a new model in the tree."""
        self._do(actions.drop, (self.project, effect), f"Dropping {effect}")

    def improve(self) -> None:
        """Add effects until what is left is noise."""
        self._do(actions.improve, (self.project,), "Improving until the rest is noise")

    def reject(self, effect: str, why: str) -> None:
        """Do not try an effect from the current model on."""
        self._take(self.project.reject(effect, why), f"{effect} is rejected from here on.")

    def accept(self, effect: str) -> None:
        """Try an effect again."""
        self._take(self.project.accept(effect), f"{effect} is tried again.")

    def back(self, node: str) -> None:
        """Make another model the current one."""
        made = self.project.back(node)
        self._take(made, f"The current model is {made.node.kept.model.spec}.")

    def name(self, name: str) -> None:
        """Name the branch that begins at the current model."""
        self._take(self.project.named(name), "The branch is named.")

    def compare_nodes(self, one: str, other: str) -> None:
        """Compare two models of the tree."""
        self._do(actions.compare_nodes, (self.project, one, other), "Comparing two models")

    def prove(self, box: Mapping[str, tuple[float, float]]) -> None:
        """Check that the current model is passive."""
        self._do(actions.prove, (self.project, dict(box)), "Proving passivity")

    def plan(self, limits: actions.Limits) -> None:
        """Plan a motion."""
        self._do(actions.plan_motion, (self.project, limits), "Planning a motion")

    # Files

    def export(self, language: str, precision: str) -> None:
        """Write the current model as a program, in a folder of its own."""
        folder = self._made(self.folder) / f"{self._stem()}-{language}"
        given = (self.project, language, precision, str(folder))
        self._do(actions.export_model, given, f"Exporting to {language}")

    def save_model(self) -> None:
        """Write the model file of the current model."""
        path = self._made(self.folder) / f"{self._stem()}.model.toml"
        self.project.save_model(path)
        self._note(self._wrote(path))

    def save_report(self) -> None:
        """Write the report of the current branch."""
        command = f"stribeck report {self.project.path}"
        self._do(actions.page_of, (self.project, command), "Writing the report")

    # Work

    def cancel(self) -> None:
        """Stop the work at once; what is known so far is kept."""
        with self._changed:
            if self.work is not None:
                title = self.work.title
                self.work.stop()
                self.work = None
                self._note(Message("done", f"Stopped: {title}. What was found before is kept."))

    def wait(self, seconds: float) -> bool:
        """Wait until no work is going on; False where it still is after `seconds`."""
        with self._changed:
            return self._changed.wait_for(lambda: self.work is None, seconds)

    @property
    def joint(self) -> Joint:
        """What the pages show."""
        if self.state.current is None:
            raise RecordingError("no file is open: open one on the page Data")
        return self.state.current

    @property
    def project(self) -> Project:
        """The project of the current joint."""
        if self.joint.project is None:
            raise ProjectError("no law is fitted yet: choose one on the page Compare")
        return self.joint.project

    def fail(self, sentence: str) -> None:
        """Show an error."""
        with self._changed:
            self._note(Message("error", self.spell(sentence)))

    def _joint(self, files: tuple[str, ...]) -> Joint:
        """What is known of these files or this project, or nothing yet."""
        for joint in reversed(self.state.joints):
            project = () if joint.project is None else (str(joint.project.path),)
            if files in (joint.files, project):
                return joint
        return Joint(files)

    def _look(self, joint: Joint, options: ReadOptions) -> None:
        joint.options = options
        joint.recording = joint.looked = None
        self._do(actions.look, (joint.files, options), f"Opening {joint.title}", joint)

    def _require_idle(self) -> None:
        if self.work is not None:
            raise SpecError(f"{self.work.title} is going on: wait for it, or stop it first")

    def _do(
        self,
        do: Callable[..., object],
        arguments: tuple[object, ...],
        title: str,
        joint: Joint | None = None,
    ) -> None:
        with self._changed:
            self._require_idle()
            of = self.joint if joint is None else joint
            if of not in self.state.joints:
                self.state.joints.append(of)
            self.state.current = of
            self.state.message = None
            self.work = Work(do, arguments, title, lambda *told: self._told(of, *told))
            self._note()

    def _told(self, joint: Joint, work: Work, kind: Kind, content: object) -> None:
        with self._changed:
            if self.work is not work:
                return
            try:
                if kind == "failed":
                    self.work = None
                    self.fail(str(content))
                elif kind == "done":
                    self.work = None
                    self.took[work.title] = work.seconds
                    self._note(self._keep(joint, content))
                elif kind == "known":
                    self._keep(joint, content)
                    self._note()
            except StribeckError as error:
                self.fail(str(error))

    def _keep(self, joint: Joint, result: object) -> Message | None:
        """Take a result into the state; returns what is said of it."""
        match result:
            case Recording():
                joint.recording = result
            case Looked():
                joint.looked = result
                # With a joint named, a wide file has that one alone.
                joint.others = result.joints if len(result.joints) > 1 else joint.others
            case Changed():
                if joint.files[0].endswith(PROJECT):
                    source = result.project.source
                    joint.files = source.named
                    joint.options = ReadOptions.of(source.options)
                joint.project = result.project
                joint.recording = result.project.recording
                if result.comparison is not None:
                    joint.comparisons[result.project.current] = result.comparison
                self._save(result.project)
            case Comparison():
                joint.laws = result
            case Sides():
                joint.sides = result
            case Certificate() if joint.project is not None:
                joint.certificates[joint.project.current] = result
            case Plan():
                joint.plan = result
                return self._save_motion(result)
            case Export():
                return self._wrote(*result.files)
            case str():
                return self._save_page(f"{self._stem()}.report.html", result)
            case RobotPage():
                return self._save_page(f"{joint.stem}.robot.report.html", result.text)
        return None

    def _take(self, project: Project, said: str) -> None:
        with self._changed:
            self._require_idle()
            self.joint.project = project
            self._save(project)
            self._note(Message("done", said))

    def _save(self, project: Project) -> None:
        with one_writer(project.path):
            project.save()
        if project.path not in self.state.written:
            self.state.written.append(project.path)

    def _save_page(self, name: str, text: str) -> Message:
        path = self._made(self.folder) / name
        write_whole(path, text)
        return self._wrote(path)

    def _save_motion(self, plan: Plan) -> Message:
        path = self._made(self.folder) / f"{self._stem()}.motion.csv"
        kind = "revolute" if plan.model.position_unit == "rad" else "prismatic"
        sidecar = f'kind = "recording"\njoint_kind = "{kind}"\n'
        write_table(path, file_bytes(plan.to_frame(), ".csv"), sidecar)
        return self._wrote(path)

    def _wrote(self, *paths: Path) -> Message:
        self.state.written += [path for path in paths if path not in self.state.written]
        return Message("done", f"Wrote {', '.join(map(str, paths))}.")

    def _stem(self) -> str:
        return f"{self.project.path.name.split('.')[0]}-{self.project.current}"

    def _made(self, folder: Path) -> Path:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StribeckError(
                f"cannot make the folder {folder}: {error.strerror or error}; give another with "
                f"--folder"
            ) from None
        return folder

    def _note(self, message: Message | None = None) -> None:
        with self._changed:
            if message is not None:
                self.state.message = replace(message, text=self.spell(message.text))
            self.state.version += 1
            self._changed.notify_all()


def _free(folder: Path, name: str) -> Path:
    """A path that no file has: ``name.csv``, ``name-2.csv`` ..."""
    stem, dot, ending = name.partition(".")
    path, number = folder / name, 1
    while path.exists():
        number += 1
        path = folder / f"{stem}-{number}{dot}{ending}"
    return path

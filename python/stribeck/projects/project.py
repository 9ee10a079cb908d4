"""A project: one recording, a tree of its models, and the current one."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import polars as pl

from stribeck.base.arguments import door
from stribeck.base.errors import ProjectError, SpecError, nearest
from stribeck.base.shown import Plotted
from stribeck.diagnosis.diagnose import diagnose as diagnose_fit
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.loop.add import add as add_to
from stribeck.diagnosis.loop.path import ImprovementPath, ImprovementStep
from stribeck.diagnosis.loop.search import MOST_STEPS, improvement_paths
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.result import Diagnosis
from stribeck.diagnosis.trials.dry_friction import check_rejected
from stribeck.diagnosis.trials.ranking import share_of_unexplained
from stribeck.effect.describe import where
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.stated.choices import ChoiceArguments, Choices
from stribeck.models.formula_law import effect_name
from stribeck.models.model import Model
from stribeck.projects.findings import Found, Remembered
from stribeck.projects.kept import Kept
from stribeck.projects.node import Node
from stribeck.projects.read import read_project
from stribeck.projects.sides import Sides
from stribeck.projects.source import Source
from stribeck.projects.tables import project_dict, project_frame
from stribeck.projects.tree import Tree
from stribeck.projects.write import write_project
from stribeck.recording.load import Given
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadArguments

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True, repr=False)
class Project(Plotted):
    """Interactive diagnosis: every method returns a new project, `save` writes it.

    Attributes
    ----------
    path
        The project file.
    source
        The recording, identified by its content, and the options that read it.
    tree
        All models; each has one effect more or fewer than its parent.
    current
        Number of the node that the methods work on.

    Examples
    --------
    >>> import stribeck as sb
    >>> p = sb.Project.new("joint.toml", "joint.csv", "coulomb")  # doctest: +SKIP
    >>> p = p.diagnose().add("load").diagnose()  # doctest: +SKIP
    >>> p = p.reject("inertia", "known from CAD").improve()  # doctest: +SKIP
    >>> p.save()  # doctest: +SKIP
    """

    path: Path
    source: Source
    tree: Tree
    current: int

    @classmethod
    def new(
        cls,
        path: str | os.PathLike[str],
        data: Given,
        base: str | Model = "coulomb",
        *,
        starts: int = 20,
        seed: int = 0,
        choices: Choices | None = None,
        **reading: Unpack[ReadArguments],
    ) -> Project:
        """Make a project of one joint; its first node is the fitted `base`.

        Parameters
        ----------
        path, data
            The project file, which is not written yet, and the recording (several are its runs).
        choices
            What is stated about parameters of `base`.
        **reading
            Options of `stribeck.read`.

        Raises
        ------
        StribeckError
            The recording cannot be read, or `base` cannot be fitted.
        """
        target = Path(path)
        source = Source.of(data, target.parent, reading)
        stated: ChoiceArguments = {} if choices is None else choices.arguments()
        kept = Kept.of(fit(base, source.recording, starts=starts, seed=seed, **stated), source)
        return cls(target, source, Tree((Node(0, None, "base", None, kept),)), 0)

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Project:
        """Read a project file, and check that its data have not changed.

        Raises
        ------
        ProjectError, ModelFileError
            The file is not a project, or its data have changed or are missing.
        """
        project = cls(Path(path), *read_project(Path(path)))
        project.source.check()
        return project

    def save(self, path: str | os.PathLike[str] | None = None) -> None:
        """Write the project file atomically; default: to `path`."""
        write_project(self, self.path if path is None else Path(path))

    def save_model(self, path: str | os.PathLike[str]) -> None:
        """Write the model file of the current node."""
        file = self.node.kept.file
        replace(file, fitted_on={**file.fitted_on, "path": self.source.file}).write(path)

    @property
    def node(self) -> Node:
        """The current node."""
        return self.tree.node(self.current)

    @property
    def recording(self) -> Recording:
        """The recording."""
        return self.source.recording

    @property
    def fit(self) -> Fit:
        """The fit of the current node."""
        return self.fit_of(self.node)

    def fit_of(self, node: Node, seed: int = 0) -> Fit:
        """Return the fit of a node; a node read from a file is fitted again from its values."""
        return node.kept.fit(self.source, seed)

    @property
    def diagnosis(self) -> Diagnosis | None:
        """The full diagnosis of the current node, if it was made in this session."""
        return self.node.diagnosis.full if self.node.diagnosis else None

    def diagnose(
        self,
        *,
        least_fall: float = LEAST_FALL,
        candidates: Collection[str] = (),
        seed: int = 0,
        progress: Callable[[str], None] = lambda sentence: None,
        known: Callable[[Project], None] = lambda project: None,
    ) -> Project:
        """Diagnose the current node, and store the findings.

        Parameters are those of `stribeck.diagnose`, but `known` gets a project; rejected effects
        are not tested.
        """
        found = diagnose_fit(
            self.fit_of(self.node, seed),
            least_fall=least_fall,
            candidates=candidates,
            seed=seed,
            rejected=self.tree.rejected(self.current),
            progress=progress,
            known=lambda found: known(self._remembering(self.current, found)),
        )
        return self._remembering(self.current, found)

    def add(self, effect: str, *, starts: int = 20, seed: int = 0) -> Project:
        """Add an effect to the current model: a new node, or the existing one.

        A rejection of the effect, here or at an ancestor, is revoked.

        Parameters
        ----------
        effect : str
            An id of the catalog, or an effect by formula: ``"creep = c*abs(load)*sgn(v)"``.

        Raises
        ------
        SpecError, FitError
            The effect is unknown, in the model already, or needs a missing channel.
        """
        name = effect_name(effect)
        known = self.tree.child(self.current, "add", name)
        if known is not None:
            known.check_formula(effect)
            tree = self.tree.accepting(self.current, name)
            return replace(self, tree=tree, current=known.number)
        before = self.fit_of(self.node, seed)
        after = add_to(before, effect, starts=starts, seed=seed)
        asked = self.node.diagnosis.finding(name) if self.node.diagnosis else None
        found = Found(
            name,
            None if asked is None else asked.confidence,
            after.rmse_held_out,
            share_of_unexplained(before, after, NoiseFloor(self.tree.noise_floor)),
            where(name, before, after),
            () if asked is None else asked.ties,
        )
        accepting = replace(self, tree=self.tree.accepting(self.current, name))
        return accepting._with_node("add", found, after)

    def drop(self, effect: str, *, starts: int = 20, seed: int = 0) -> Project:
        """Drop an effect of the current model: a new node, or the existing one.

        Raises `SpecError` if the model has no such effect, or the effect is part of its law.
        """
        model = self.node.kept.model
        has = (*model.own_effects, *model.effects)
        if effect not in has:
            if model.has(effect):
                part = f"{effect} is part of the law {model.law} and cannot be dropped"
                raise SpecError(f"{part}: make a project with another base")
            there = f"it has {', '.join(has)}" if has else "nothing was added to it"
            raise SpecError(
                f"effect {effect!r} is not in {model.spec}{nearest(effect, has) or f'; {there}'}"
            )
        known = self.tree.child(self.current, "drop", effect)
        if known is not None:
            return replace(self, current=known.number)
        before = self.fit_of(self.node, seed)
        after = fit(
            model.without_effect(effect),
            self.recording,
            starts=starts,
            seed=seed,
            transient=before.transient,
        )
        found = Found(effect, None, after.rmse_held_out, None, where(effect, after, before))
        return self._with_node("drop", found, after)

    def reject(self, effect: str, why: str = "") -> Project:
        """Exclude an effect from tests at the current node and its descendants.

        Raises `SpecError` if the effect is unknown, or in the model already.
        """
        model = self.node.kept.model
        check_rejected((effect,))
        if model.has(effect):
            raise SpecError(f"effect {effect!r} is in {model.spec} already: drop it instead")
        return self._rejecting(self.current, effect, why)

    def accept(self, effect: str) -> Project:
        """Revoke the rejection of an effect, at the current node or an ancestor.

        Raises `ProjectError` if it is not rejected.
        """
        rejected = self.tree.rejected(self.current)
        if effect not in rejected:
            known = f"; rejected are {', '.join(rejected)}" if rejected else ""
            raise ProjectError(f"effect {effect!r} is not rejected at node {self.current}{known}")
        return replace(self, tree=self.tree.accepting(self.current, effect))

    def back(self, node: str | int | None = None) -> Project:
        """Make another node the current one, by number or name; default: the parent.

        Raises `ProjectError` if there is no such node, or the current one has no parent.
        """
        if node is not None:
            return replace(self, current=self.tree.find(node).number)
        if self.node.parent is None:
            raise ProjectError(f"{self.path}: node {self.current} is the base and has no parent")
        return replace(self, current=self.node.parent)

    def named(self, name: str) -> Project:
        """Name the branch that begins at the current node; an empty text removes the name.

        Raises `ProjectError` if the name is a number, or that of another node.
        """
        word = name.strip()
        if word.isdecimal():
            raise ProjectError(f"{word} is a number, which could be that of a node: give a word")
        taken = [n.number for n in self.tree if n.name == word and word]
        if taken and taken != [self.current]:
            raise ProjectError(f"node {taken[0]} has the name {word!r} already: give another")
        return replace(self, tree=self.tree.with_changed(self.current, name=word))

    def improve(
        self,
        *,
        least_fall: float = LEAST_FALL,
        most_steps: int = MOST_STEPS,
        candidates: Collection[str] = (),
        seed: int = 0,
        progress: Callable[[str], None] = lambda sentence: None,
        each: Callable[[Project], None] = lambda project: None,
    ) -> Project:
        """Diagnose and add effects from the current node until none passes; each step is a node.

        An effect that becomes superfluous stays as a branch. The search continues without it at a
        node where it is rejected, with the reason.

        Parameters
        ----------
        each : callable
            Called with the project after each change, to save it.

        The other parameters are those of `stribeck.improve`.
        """
        start = self.current
        project = self
        for way in improvement_paths(
            self.fit_of(self.node, seed),
            least_fall=least_fall,
            most_steps=most_steps,
            rejected=self.tree.rejected(start),
            candidates=candidates,
            seed=seed,
            progress=progress,
        ):
            project = project._along(start, way)
            each(project)
        return project

    def compare(self, one: str | int, other: str | int, *, seed: int = 0) -> Sides:
        """Compare two nodes, given by number or name."""
        first, second = self.tree.find(one), self.tree.find(other)
        fits = (self.fit_of(first, seed), self.fit_of(second, seed))
        return Sides.of((first, second), fits, self.recording)

    def _with_node(self, change: str, found: Found, fitted: Fit) -> Project:
        tree, made = self.tree.with_node(
            parent=self.current, change=change, found=found, kept=Kept.of(fitted, self.source)
        )
        return replace(self, tree=tree, current=made.number)

    def _remembering(self, number: int, diagnosis: Diagnosis) -> Project:
        made = self.tree.with_changed(number, diagnosis=Remembered.of(diagnosis))
        return replace(self, tree=made)

    def _rejecting(self, number: int, effect: str, why: str) -> Project:
        rejected = {**self.tree.node(number).rejected, effect: why}
        return replace(self, tree=self.tree.with_changed(number, rejected=rejected))

    def _along(self, start: int, way: ImprovementPath) -> Project:
        """Return the project with the nodes of `way` from `start`."""
        project = replace(self, current=start)
        for gone in way.dropped:
            node = project.tree.holding(gone.before)
            if node is not None and gone.effect not in project.tree.rejected(node.number):
                project = project._rejecting(node.number, gone.effect, gone.reason)
        for step in way.steps:
            project = project._with_step(step)
        asked = project.tree.holding(way.last.fit)
        return project if asked is None else project._remembering(asked.number, way.last)

    def _with_step(self, step: ImprovementStep) -> Project:
        """Take a step from the current node, to an existing node or a new one."""
        known = self.tree.holding(step.after)
        if known is not None:
            return replace(self, current=known.number)
        found = Found.of(step.finding)
        known = self.tree.child(self.current, "add", found.effect)
        # The search did not use the rejections at that node, so its steps form another branch.
        if known is None or known.rejected:
            return self._with_node("add", found, step.after)
        kept = Kept.of(step.after, self.source)
        tree = self.tree.with_changed(known.number, found=found, kept=kept)
        return replace(self, tree=tree, current=known.number)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON that the commands print."""
        return project_dict(self)

    def to_frame(self) -> pl.DataFrame:
        """Return a table with one row for each node."""
        return project_frame(self)


@door(ProjectError)
def project(path: str | os.PathLike[str]) -> Project:
    """Open a project file, and check that its data have not changed; see `Project`.

    Examples
    --------
    >>> import numpy as np, polars as pl, stribeck as sb, tempfile
    >>> v = np.sin(np.arange(900) / 50.0)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     frame = pl.DataFrame({"t": np.arange(900) / 100.0, "qd": v, "tau": v + np.sign(v)})
    ...     frame.write_csv(f"{folder}/joint.csv")
    ...     sb.Project.new(f"{folder}/p.toml", f"{folder}/joint.csv", starts=1).save()
    ...     sb.project(f"{folder}/p.toml").fit.model.spec
    'coulomb'
    """
    return Project.open(path)

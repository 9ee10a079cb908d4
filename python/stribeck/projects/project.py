"""A project: one recording, a tree of models of it, and which of them is worked on."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import polars as pl

from stribeck.base.errors import ProjectError, SpecError, nearest
from stribeck.base.shown import Plotted
from stribeck.diagnosis.diagnose import LEAST_FALL
from stribeck.diagnosis.diagnose import diagnose as diagnose_fit
from stribeck.diagnosis.loop.add import add as add_to
from stribeck.diagnosis.loop.path import (
    MOST_STEPS,
    ImprovementPath,
    ImprovementStep,
    improvement_paths,
)
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.result import Diagnosis
from stribeck.diagnosis.trials.ranking import share_of_unexplained
from stribeck.effect.describe import where
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.models.catalog import check_effect
from stribeck.models.formula_law import effect_name, effect_terms, is_formula
from stribeck.models.model import Model
from stribeck.projects.findings import Found, Remembered
from stribeck.projects.kept import Kept
from stribeck.projects.node import Node
from stribeck.projects.sides import Sides
from stribeck.projects.source import Source
from stribeck.projects.tables import project_dict, project_frame
from stribeck.projects.tree import Tree
from stribeck.recording.options import ReadArguments
from stribeck.recording.recording import Recording

if TYPE_CHECKING:
    from typing_extensions import Unpack


def _silent(sentence: str) -> None:
    """Progress that nobody asked for."""


@dataclass(frozen=True, repr=False)
class Project(Plotted):
    """The loop driven by hand: every verb returns the next project, `save` writes it.

    Attributes
    ----------
    path
        The project file.
    source
        The data, by content, and how they were read.
    tree
        Every model that was made, each from its parent by one effect added or dropped.
    current
        Number of the node that the verbs work on.

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
        data: str | os.PathLike[str],
        base: str | Model = "coulomb",
        *,
        starts: int = 20,
        seed: int = 0,
        **reading: Unpack[ReadArguments],
    ) -> Project:
        """A project of one recording; its first node is `base`, fitted.

        Parameters
        ----------
        path, data
            The project file, which is not written yet, and the recording.
        **reading
            Options of `stribeck.read`.

        Raises
        ------
        StribeckError
            The data cannot be read, or `base` not fitted to them.
        """
        target = Path(path)
        source = Source.of(data, target.parent, reading)
        kept = Kept.of(fit(base, source.recording, starts=starts, seed=seed), source)
        return cls(target, source, Tree((Node(0, None, "base", None, kept),)), 0)

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Project:
        """Read a project file, and check that its data are the same still.

        Raises
        ------
        ProjectError, ModelFileError
            The file is no project, or its data have changed or are gone.
        """
        from stribeck.projects.read import read_project

        project = read_project(Path(path))
        project.source.check()
        return project

    def save(self, path: str | os.PathLike[str] | None = None) -> None:
        """Write the project file whole or not at all; default: where it came from."""
        from stribeck.projects.write import write_project

        write_project(self, self.path if path is None else Path(path))

    def save_model(self, path: str | os.PathLike[str]) -> None:
        """Write the current model's file."""
        file = self.node.kept.file
        data = str(self.source.file)
        replace(file, fitted_on={**file.fitted_on, "path": data}).write(path)

    @property
    def node(self) -> Node:
        """The node that the verbs work on."""
        return self.tree.node(self.current)

    @property
    def recording(self) -> Recording:
        """The data."""
        return self.source.recording

    @property
    def fit(self) -> Fit:
        """The current model's fit."""
        return self.fit_of(self.node)

    def fit_of(self, node: Node, seed: int = 0) -> Fit:
        """A node's fit; one that is known from the file alone is fitted again from its values."""
        return node.kept.fit(self.source, seed)

    @property
    def diagnosis(self) -> Diagnosis | None:
        """The full diagnosis of the current node, if this session has made it."""
        return self.node.diagnosis.full if self.node.diagnosis else None

    def diagnose(
        self,
        *,
        least_fall: float = LEAST_FALL,
        candidates: Collection[str] = (),
        seed: int = 0,
    ) -> Project:
        """Ask what is missing at the current node, and remember the findings.

        Parameters are those of `stribeck.diagnose`; rejected effects are not tried.
        """
        found = diagnose_fit(
            self.fit_of(self.node, seed),
            least_fall=least_fall,
            candidates=candidates,
            seed=seed,
            rejected=self.tree.rejected(self.current),
        )
        return self._remembering(self.current, found)

    def add(self, effect: str, *, starts: int = 20, seed: int = 0) -> Project:
        """Add an effect to the current model: a new node, or the one that did so before.

        Parameters
        ----------
        effect : str
            An id of the catalog, or an effect by formula: ``"creep = c*abs(load)*sgn(v)"``.

        Raises
        ------
        SpecError, FitError
            The effect is unknown, in the model already, or needs a channel that is not there.
        """
        name = effect_name(effect)
        known = self.tree.child(self.current, "add", name)
        if known is not None:
            _check_same(known, effect)
            return replace(self, current=known.number)
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
        return self._with_node("add", found, after)

    def drop(self, effect: str, *, starts: int = 20, seed: int = 0) -> Project:
        """Go on without an effect of the current model: a new node.

        Raises
        ------
        SpecError
            The model has no such effect, or its law has it by itself.
        """
        model = self.node.kept.model
        has = (*model.own_effects, *model.effects)
        if effect not in has:
            if model.has(effect):
                raise SpecError(
                    f"{model.law} has {effect} by itself, so it cannot be dropped: make a project "
                    f"with another base"
                )
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
        """Never try an effect at the current node, nor at those that come from it.

        Raises
        ------
        SpecError
            The effect is unknown, or in the model already.
        """
        model = self.node.kept.model
        check_effect(effect)
        if model.has(effect):
            raise SpecError(f"effect {effect!r} is in {model.spec} already: drop it instead")
        return self._rejecting(self.current, effect, why)

    def accept(self, effect: str) -> Project:
        """Take back that an effect was rejected, wherever on the way to the current node.

        Raises
        ------
        ProjectError
            It was not.
        """
        rejected = self.tree.rejected(self.current)
        if effect not in rejected:
            known = f"; rejected are {', '.join(rejected)}" if rejected else ""
            raise ProjectError(f"effect {effect!r} is not rejected at node {self.current}{known}")
        tree = self.tree
        for node in self.tree.path(self.current):
            left = {e: why for e, why in node.rejected.items() if e != effect}
            tree = tree.with_changed(node.number, rejected=left)
        return replace(self, tree=tree)

    def back(self, node: str | int | None = None) -> Project:
        """Work on another node, by number or name; default: the one before.

        Raises
        ------
        ProjectError
            There is no such node, or none before.
        """
        if node is not None:
            return replace(self, current=self.tree.find(node).number)
        if self.node.parent is None:
            raise ProjectError(f"{self.path}: node {self.current} is the base, nothing is before")
        return replace(self, current=self.node.parent)

    def named(self, name: str) -> Project:
        """Name the branch that begins at the current node; an empty name takes it away.

        Raises
        ------
        ProjectError
            The name is a number, or that of another node.
        """
        word = name.strip()
        if word.isdecimal():
            raise ProjectError(f"{word} would be taken for a node's number: give it a word")
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
        progress: Callable[[str], None] = _silent,
        each: Callable[[Project], None] = lambda project: None,
    ) -> Project:
        """Diagnose and add from the current node until nothing passes: every step a node.

        An effect that a later one makes superfluous stays as a branch of its own; the way goes on
        beside it, where it is rejected with the reason.

        Parameters
        ----------
        each : callable
            Told the project after each change, to save it.

        The others are those of `stribeck.improve`.
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
        """Two nodes side by side, by number or name."""
        first, second = self.tree.find(one), self.tree.find(other)
        return Sides.of(
            (first, second), (self.fit_of(first, seed), self.fit_of(second, seed)), self.recording
        )

    def _with_node(self, change: str, found: Found, fitted: Fit) -> Project:
        tree, made = self.tree.with_node(
            parent=self.current, change=change, found=found, kept=Kept.of(fitted, self.source)
        )
        return replace(self, tree=tree, current=made.number)

    def _remembering(self, number: int, diagnosis: Diagnosis) -> Project:
        said = Remembered.of(diagnosis)
        return replace(self, tree=self.tree.with_changed(number, diagnosis=said))

    def _rejecting(self, number: int, effect: str, why: str) -> Project:
        rejected = {**self.tree.node(number).rejected, effect: why}
        return replace(self, tree=self.tree.with_changed(number, rejected=rejected))

    def _along(self, start: int, way: ImprovementPath) -> Project:
        """The project with the nodes of a way that begins at `start`, at the way's end."""
        project = replace(self, current=start)
        for gone in way.superfluous:
            node = project.tree.holding(gone.before)
            if node is not None and gone.effect not in project.tree.rejected(node.number):
                why = f"superfluous once {gone.because} is in the model"
                project = project._rejecting(node.number, gone.effect, why)
        for step in way.steps:
            project = project._with_step(step)
        asked = project.tree.holding(way.last.fit)
        return project if asked is None else project._remembering(asked.number, way.last)

    def _with_step(self, step: ImprovementStep) -> Project:
        """One step on from the current node, by a node that took it before or a new one."""
        known = self.tree.holding(step.after)
        if known is not None:
            return replace(self, current=known.number)
        found = Found.of(step.finding)
        known = self.tree.child(self.current, "add", found.effect)
        # What was rejected there the loop has not heeded, so that its way is another branch.
        if known is None or known.rejected:
            return self._with_node("add", found, step.after)
        kept = Kept.of(step.after, self.source)
        tree = self.tree.with_changed(known.number, found=found, kept=kept)
        return replace(self, tree=tree, current=known.number)

    def to_dict(self) -> dict[str, object]:
        """What the commands print as JSON."""
        return project_dict(self)

    def to_frame(self) -> pl.DataFrame:
        """One row a node."""
        return project_frame(self)


def _check_same(known: Node, effect: str) -> None:
    """Refuse another formula under a name that was added here before."""
    own = known.kept.model.formula(known.effect or "")
    if own is None or not is_formula(effect):
        return
    text = effect_terms(effect).text
    if text != own.text:
        raise SpecError(
            f"{own.name} = {own.text} was added here before (node {known.number}): give "
            f"{text!r} another name"
        )


def project(path: str | os.PathLike[str]) -> Project:
    """Open a project file, and check that its data are the same still; see `Project`."""
    return Project.open(path)

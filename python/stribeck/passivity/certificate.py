"""What a check of passivity yields: a proof, a counterexample, or neither."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from stribeck import _core
from stribeck.base.shown import Shown
from stribeck.models.model import Model

#: What each condition says.
MEANING = {
    "sliding": "friction in steady sliding opposes the motion",
    "damping": "bristle damping: 0 <= s1 <= 4 D/|v| (Tadese et al. 2021, property 1, i)",
    "resistance": "what is beside the bristle opposes the motion (property 1, ii)",
    "storage": "at each operating point more is dissipated than goes into the bristle",
    "cycle": "no cycle of the bristle gives off energy",
    "elements": "elements of constant strength, each a spring and a slider",
    "unknown": "none is known for this kind of model",
}


@dataclass(frozen=True)
class Margin:
    """By how much a condition holds over the box.

    Attributes
    ----------
    lower
        No operating point has less, proved, in the unit of torque; None where nothing is.
    upper
        The point `at` has no more; None where no point was looked for.
    """

    condition: str
    lower: float | None
    upper: float | None
    at: Mapping[str, float] | None

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "condition": self.condition,
            "lower": self.lower,
            "upper": self.upper,
            "at": None if self.at is None else dict(self.at),
        }


@dataclass(frozen=True)
class Counterexample:
    """A motion from which energy comes, and after which the model is as it was before.

    Attributes
    ----------
    deflection
        Of the bristle at the start and at the end, rad or m; None: the joint slides already.
    steps
        Operating points that are held one after the other, each with its ``duration`` in s.
    net_work
        Work that the friction takes over all of them, J: negative.
    """

    friction: Model
    deflection: float | None
    steps: tuple[Mapping[str, float], ...]
    net_work: float

    @property
    def kind(self) -> str:
        """``"operating point"`` or ``"cycle"``."""
        return "operating point" if len(self.steps) == 1 else "cycle"

    def replay(self) -> tuple[float, float]:
        """Carry the motion out by the model's exact step.

        Returns
        -------
        work : float
            J.
        deflection : float
            At the end, rad or m.
        """
        steps = [
            (step["duration"], {k: v for k, v in step.items() if k != "duration"})
            for step in self.steps
        ]
        return _core.work(self.friction.core, self.friction.values, self.deflection, steps)

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "kind": self.kind,
            "deflection": self.deflection,
            "steps": [dict(step) for step in self.steps],
            "net_work_J": self.net_work,
        }


@dataclass(frozen=True, repr=False)
class Certificate(Shown):
    """Whether a model is passive over an operating box.

    Attributes
    ----------
    passive
        True: proved. False: `counterexample` breaks it. None: cannot decide, with the reason in
        `why`.
    condition
        What the proof rests on, or what is broken or open: ``sliding``, ``damping``,
        ``resistance``, ``storage``, ``cycle``, ``elements``, ``unknown``.
    margins
        All conditions that were looked at.
    friction
        The part of the model that it is about.
    left_out
        Effects and rigid-body terms that are no friction.
    """

    model: Model
    friction: Model
    left_out: tuple[str, ...]
    box: Mapping[str, tuple[float, float]]
    passive: bool | None
    condition: str
    margins: tuple[Margin, ...]
    counterexample: Counterexample | None

    @property
    def margin(self) -> float | None:
        """By how much `condition` holds (a proven bound) or is broken (at a point), in N m or N."""
        row = next((m for m in reversed(self.margins) if m.condition == self.condition), None)
        if row is None:
            return None
        return row.upper if self.passive is False else row.lower

    @property
    def why(self) -> str | None:
        """Why nothing could be decided; None where it was."""
        if self.passive is not None:
            return None
        if self.condition == "unknown":
            return (
                f"no exact condition is known here for the states or branches of "
                f"{self.friction.spec}"
            )
        return (
            f"neither a proof nor a counterexample was found for the condition "
            f"{self.condition!r} ({MEANING[self.condition]}); a smaller box may help"
        )

    def to_dict(self) -> dict[str, Any]:
        """The JSON of `stribeck check`."""
        example = self.counterexample
        return {
            "model": self.model.spec,
            "passive": self.passive,
            "box": {name: list(side) for name, side in self.box.items()},
            "margin": self.margin,
            "condition": self.condition,
            "counterexample": None if example is None else example.to_dict(),
            "margins": [margin.to_dict() for margin in self.margins],
            "friction": self.friction.spec,
            "left_out": list(self.left_out),
            "torque_unit": self.friction.torque_unit,
            "why": self.why,
        }

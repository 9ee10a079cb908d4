"""The result of a check of passivity: a proof, a counterexample, or neither."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from stribeck import _core
from stribeck.base.shown import Shown
from stribeck.models.model import Model

#: What each condition states.
MEANING = {
    "sliding": "friction in steady sliding opposes the motion",
    "damping": "bristle damping: 0 <= s1 <= 4 D/|v| (Tadese et al. 2021, property 1, i)",
    "resistance": "friction in parallel with the bristle opposes the motion (property 1, ii)",
    "storage": "at each operating point more energy is dissipated than the bristle stores",
    "cycle": "no cycle of the bristle generates energy",
    "elements": "elements of constant strength, each a spring in series with a slider",
    "unknown": "no exact condition is known for this kind of model",
}


@dataclass(frozen=True)
class Margin:
    """By how much a condition holds over the box.

    Attributes
    ----------
    lower
        Proved lower bound of the margin over the box, in the unit of torque; None where nothing is
        proved.
    upper
        Margin at the operating point `at`, an upper bound of the least margin; None where no point
        was evaluated.
    at
        An operating point by channel, SI units and degC.
    """

    condition: str
    lower: float | None
    upper: float | None
    at: Mapping[str, float] | None

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "condition": self.condition,
            "lower": self.lower,
            "upper": self.upper,
            "at": None if self.at is None else dict(self.at),
        }


@dataclass(frozen=True)
class Counterexample:
    """A motion that generates energy, with the same state of the model at its start and its end.

    Attributes
    ----------
    friction
        The model that is moved.
    deflection
        Deflection of the bristle at the start and at the end, rad or m; None where the joint slides
        throughout.
    steps
        Operating points held one after the other, each with its ``duration`` in s.
    net_work
        Work done against friction over all steps, J; negative.
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
        """Simulate the motion with the model's exact step.

        Returns
        -------
        work : float
            Work done against friction, J.
        deflection : float
            Deflection of the bristle at the end, rad or m.
        """
        steps = [
            (step["duration"], {k: v for k, v in step.items() if k != "duration"})
            for step in self.steps
        ]
        return _core.work(self.friction.core, self.friction.values, self.deflection, steps)

    def to_dict(self) -> dict[str, object]:
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
        True with a proof, False with a `counterexample`, None where neither was found; `why` then
        gives the reason.
    condition
        The condition that the proof rests on, or that is violated or undecided: ``sliding``,
        ``damping``, ``resistance``, ``storage``, ``cycle``, ``elements``, ``unknown``.
    margins
        All conditions that were evaluated.
    model, friction
        The model, and the part of it that is friction.
    left_out
        Effects and rigid-body terms that are not friction.
    box
        Operating box of the friction, SI units and degC.

    Examples
    --------
    >>> import stribeck as sb
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> sb.check(friction, {"velocity": (-3.0, 3.0)}).passive
    True
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
        """By how much `condition` holds (a proved bound) or is violated (at a point), N m or N."""
        row = next((m for m in reversed(self.margins) if m.condition == self.condition), None)
        if row is None:
            return None
        return row.upper if self.passive is False else row.lower

    @property
    def why(self) -> str | None:
        """Why the check is undecided; None where it is not."""
        if self.passive is not None:
            return None
        if self.condition == "unknown":
            return f"no exact condition is known for the states or branches of {self.friction.spec}"
        return (
            f"neither a proof nor a counterexample was found for condition "
            f"{self.condition!r} ({MEANING[self.condition]}); a smaller box may help"
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON of the command ``stribeck check``."""
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

"""The result of a plan: the motion, and the expected visibility of effects in a recording of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl

from stribeck.base.shown import Plotted
from stribeck.diagnosis.visibility.smallest import VisibleEffect
from stribeck.models.model import Model
from stribeck.motion.design.motion import Limits, SampledMotion


@dataclass(frozen=True)
class Size:
    """The smallest visible effect: value of its parameter, and RMS of its torque."""

    value: float | None
    rms: float | None

    @classmethod
    def of(cls, shown: VisibleEffect) -> Size:
        """Return the size, or None if no size is visible."""
        if not np.isfinite(shown.factor):
            return cls(None, None)
        result = shown.result("")
        return cls(float(result.value), float(result.rms))

    def to_dict(self) -> dict[str, float | None]:
        """As JSON."""
        return {"value": self.value, "rms": self.rms}


@dataclass(frozen=True)
class Prospect:
    """Expected visibility of one effect.

    Attributes
    ----------
    inverse
        Whether the effect becomes smaller when its parameter grows.
    before, after
        Smallest size visible in the present data (None without data) and in the planned motion.
    advice
        What the motion cannot show of it; may be empty.
    """

    effect: str
    parameter: str
    unit: str
    inverse: bool
    before: Size | None
    after: Size
    advice: str

    @property
    def gain(self) -> float | None:
        """Factor by which the smallest visible effect decreases; None if it is unknown."""
        before = None if self.before is None else self.before.value
        if before is None or self.after.value is None:
            return None
        return self.after.value / before if self.inverse else before / self.after.value

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "effect": self.effect,
            "parameter": self.parameter,
            "unit": self.unit,
            "before": None if self.before is None else self.before.to_dict(),
            "after": self.after.to_dict(),
            "gain": self.gain,
            "advice": self.advice or None,
        }


@dataclass(frozen=True, repr=False)
class Plan(Plotted):
    """A motion, and the expected visibility of effects in a recording of it.

    Attributes
    ----------
    motion, rate
        Samples of the motion, and the sampling rate, Hz.
    kind
        Family of the motion.
    cosines
        Similarity of each pair of effects to distinguish, 0 to 1: in the present data (None without
        data) and in the planned motion.

    Examples
    --------
    >>> import stribeck as sb
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> limits = {"position": (-1.0, 1.0), "speed": 2.0, "acceleration": 10.0}
    >>> file, asked = sb.ModelFile(friction), {"show": ["stribeck"], "duration": 10.0}
    >>> planned = sb.plan(file, **limits, **asked, rate=50.0, noise=0.1)
    >>> planned.prospects[0].effect, planned.prospects[0].after.rms < 0.1
    ('stribeck', True)
    >>> planned.to_frame().columns
    ['time', 'position', 'velocity', 'acceleration']
    """

    model: Model
    motion: SampledMotion
    rate: float
    kind: str
    limits: Limits
    prospects: tuple[Prospect, ...]
    cosines: Mapping[tuple[str, str], tuple[float | None, float]]
    source: str | None
    seed: int
    notes: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """Seconds."""
        return float(self.motion.time[-1])

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck plan`."""
        m, limits = self.motion, self.limits
        return {
            "model": self.model.spec,
            "data": self.source,
            "motion": {
                "kind": self.kind,
                "duration": self.duration,
                "rate_hz": self.rate,
                "rows": int(m.time.size),
                "position": [float(m.position.min()), float(m.position.max())],
                "speed": float(np.abs(m.velocity).max()),
                "acceleration": float(np.abs(m.acceleration).max()),
            },
            "limits": {
                "position": [limits.low, limits.high],
                "speed": limits.speed,
                "acceleration": limits.acceleration,
            },
            "effects": [row.to_dict() for row in self.prospects],
            "torque_unit": self.model.torque_unit,
            "cosines": [
                {"effects": list(pair), "before": before, "after": after}
                for pair, (before, after) in self.cosines.items()
            ],
            "seed": self.seed,
            "notes": list(self.notes),
        }

    def to_frame(self) -> pl.DataFrame:
        """The motion as a table: time, position, velocity, acceleration."""
        m = self.motion
        return pl.DataFrame(
            {
                name: getattr(m, name) + 0.0
                for name in ("time", "position", "velocity", "acceleration")
            }
        )

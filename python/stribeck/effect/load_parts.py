"""The load torque as the sum of torques that are effects of the catalog.

A gain scales friction and load torque alike, and any friction may be larger by it. Where the load
torque is that of an inertia and a weight alone, a gain is therefore the same as an inertia and a
weight that are both wrong by its share. Their held-out errors may differ all the same: the load
torque and the acceleration of the motion are behind different filters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.base import linear
from stribeck.effect.base import Identified, Obstacle
from stribeck.models.model import Model
from stribeck.recording.mend.load_of_motion import slow_motion
from stribeck.recording.recording import Recording

#: Share of what varies of the load torque from which on a torque is a part of it.
PART = 0.03
#: Share that the parts may leave of it: filters and errors of the position leave less.
REST = 0.1
#: Cosine of the angle between two weights from which on they are parallel.
PARALLEL = 0.98
#: The effect that is a scale of the load torque.
SCALE = "gain"
#: The effects that may be parts of it.
EFFECTS = ("inertia", "gravity", "offset")
#: Effects whose torque of position holds that of another.
HOLDS = {"spring": "gravity"}


@dataclass(frozen=True)
class LoadParts:
    """What a load torque consists of.

    Attributes
    ----------
    effects
        The effects whose torques are all of it; none where it holds more than these.
    weight
        Its factors of the cosine and the sine of the position.
    """

    effects: tuple[str, ...]
    weight: tuple[float, float]

    @classmethod
    def of(cls, recording: Recording) -> LoadParts:
        """Of the recorded load torque, in slow motion, which no filter changes.

        Examples
        --------
        >>> t = np.arange(0.0, 20.0, 0.01)
        >>> q = np.sin(t) + 0.3 * np.sin(2.7 * t)
        >>> a = -np.sin(t) - 0.3 * 2.7**2 * np.sin(2.7 * t)
        >>> def parts(load):
        ...     r = Recording.from_columns(time=t, position=q, torque=np.sin(t), load_torque=load)
        ...     return LoadParts.of(r).effects
        >>> parts(2.0 * a), parts(2.0 * a + 5.0 * np.cos(q)), parts(2.0 * a + 5.0 * (t > 7.0))
        (('inertia',), ('inertia', 'gravity'), ())
        """
        if "load parts" not in recording.remembered:
            recording.remembered["load parts"] = _split(recording)
        split = recording.remembered["load parts"]
        effects = (e for e in EFFECTS if split["rest"] <= REST and split[e] > PART)
        return cls(tuple(effects), (split["cosine"], split["sine"]))


def absorbed(effect: str, model: Model, recording: Recording) -> Obstacle | None:
    """Why `effect` cannot be told beside those of a model: together they scale the load torque."""
    others = _others(HOLDS.get(effect, effect), recording)
    if not others or not all(_has(model, other) for other in others):
        return None
    are = "is" if len(others) == 1 else "are"
    return Obstacle(
        f"{' and '.join(others)} {are} in the model, and the load torque holds no more than the "
        "torque of an inertia and a weight: a common scale of load torque and friction is "
        "indistinguishable from an error of these",
        "add a load that is known from a weighing, or measure the torque constant",
    )


def alike(effect: str, _: Identified, after: Identified) -> tuple[str, ...]:
    """The effects that in the place of `effect` would scale the load torque alike.

    Each of an inertia, a weight and a gain is the sum of the others: beside all but one of these,
    that one does what `effect` does.
    """
    others = _others(effect, after.recording)
    missing = tuple(other for other in others if not _has(after.model, other))
    return missing if len(missing) == 1 and _is_parallel(effect, after) else ()


def _others(effect: str, recording: Recording) -> tuple[str, ...]:
    """The effects that `effect` is the sum of; none where the load torque has parts beside them."""
    parts = LoadParts.of(recording).effects
    return tuple(e for e in (*parts, SCALE) if e != effect) if effect in (*parts, SCALE) else ()


def _has(model: Model, effect: str) -> bool:
    """Whether the effects of a model, or its rigid body, hold the torque of an effect."""
    inside = (*model.effects, *model.rigid_body)
    return effect in inside or any(HOLDS.get(other) == effect for other in inside)


def _is_parallel(effect: str, after: Identified) -> bool:
    """Whether a weight that was found has the direction of that of the load torque."""
    if effect != "gravity":
        return True
    found = np.array([after.model.value("gravity_cos"), after.model.value("gravity_sin")])
    given = np.array(LoadParts.of(after.recording).weight)
    size = float(np.linalg.norm(found) * np.linalg.norm(given))
    return size > 0.0 and abs(float(found @ given)) >= PARALLEL * size


def _split(r: Recording) -> dict[str, float]:
    """Shares of what varies of the load torque, of each effect and the rest; the weight's factors.

    All of it is the rest where it cannot be split.
    """
    split = {"rest": 1.0, **dict.fromkeys((*EFFECTS, "cosine", "sine"), 0.0)}
    load, acceleration, rows = r.load_torque, r.acceleration, r.moving
    if load is None or acceleration is None or r.averaged or not rows.any():
        return split
    slow = slow_motion(r.time, r.velocity, r.segment)
    shapes = [acceleration, np.ones_like(load)]
    if r.position is not None and r.joint_kind == "revolute":
        shapes += [np.cos(r.position), np.sin(r.position)]
    columns = np.column_stack([slow.smooth(shape) for shape in shapes])[rows]
    whole = slow.smooth(load)[rows]
    size = float(np.std(whole))
    if not size > 0.0:
        return split
    factors = linear.least_norm(columns, whole)
    weight = columns[:, 2:] @ factors[2:]
    torques = {
        "rest": whole - columns @ factors,
        "inertia": columns[:, 0] * factors[0],
        # A constant belongs to a weight that hardly turns.
        "gravity": weight - weight.mean(),
        "offset": columns[:, 1] * factors[1],
    }
    split |= {name: float(np.sqrt(np.mean(x**2))) / size for name, x in torques.items()}
    return split | dict(zip(("cosine", "sine"), map(float, factors[2:]), strict=False))

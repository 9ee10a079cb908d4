"""Which joints have an effect that most other joints lack."""

from __future__ import annotations

import statistics
from collections import Counter
from dataclasses import dataclass

import polars as pl

from stribeck.base.errors import option
from stribeck.scale.fleet.identified import IMPROVE
from stribeck.scale.fleet.store import DONE, as_name

#: An effect stands out if no more than this share of the other joints have it.
FEW = 0.25
#: Smallest number of joints of the same name to compare with; otherwise all joints of the fleet are
#: used.
FEWEST_PEERS = 3

#: Why there is no result for effects if one model was fitted everywhere.
NOT_ASKED = f"one model was fitted everywhere: {option('model', IMPROVE)} looks for missing effects"


@dataclass(frozen=True)
class JointEffect:
    """An effect that was found at a joint on most of its days.

    Attributes
    ----------
    days_found, days
        Number of days on which it was found, and of all days.
    confidence
        Median over the days on which it was found.
    tied
        Effects indistinguishable from it on at least one day.
    peers, peers_with
        Number of other joints of the same name (all other joints if those are few), and how many of
        them have the effect or one indistinguishable from it.
    """

    robot: str | None
    joint: str | None
    effect: str
    days_found: int
    days: int
    confidence: float
    tied: tuple[str, ...]
    peers: int
    peers_with: int

    @property
    def is_odd(self) -> bool:
        """Whether most of the other joints lack it."""
        return self.peers > 0 and self.peers_with <= FEW * self.peers

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "robot": self.robot,
            "joint": self.joint,
            "effect": self.effect,
            "odd": self.is_odd,
            "days_found": self.days_found,
            "days": self.days,
            "confidence": self.confidence,
            "indistinguishable_from": list(self.tied),
            "peers": self.peers,
            "peers_with": self.peers_with,
        }


@dataclass(frozen=True)
class Share:
    """How many of the joints of a name have an effect."""

    joint: str | None
    effect: str
    having: int
    joints: int

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "joint": self.joint,
            "effect": self.effect,
            "having": self.having,
            "joints": self.joints,
        }


@dataclass(frozen=True)
class Effects:
    """Effects over a fleet.

    Attributes
    ----------
    joints
        Every effect of every joint, the rarest among the peers first.
    shares
        Shares by name of joint and effect, the most frequent effects first.
    why
        Why there is no result; None if there is one.
    """

    joints: tuple[JointEffect, ...]
    shares: tuple[Share, ...]
    why: str | None

    @classmethod
    def not_asked(cls) -> Effects:
        """Return the result if one model was fitted everywhere."""
        return cls((), (), NOT_ASKED)

    @property
    def odd(self) -> tuple[JointEffect, ...]:
        """Effects that most other joints lack."""
        return tuple(each for each in self.joints if each.is_odd)

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "why": self.why,
            "odd": [each.to_dict() for each in self.odd],
            "shares": [share.to_dict() for share in self.shares],
            "joints": [each.to_dict() for each in self.joints],
        }


@dataclass(frozen=True)
class _Joint:
    """Effects found at one joint on its days."""

    robot: str | None
    joint: str | None
    days: int
    found: dict[str, list[float]]
    tied: dict[str, Counter[str]]

    def has(self, effect: str) -> bool:
        """Whether the effect was found on more than half of the days."""
        return 2 * len(self.found.get(effect, ())) > self.days

    def may_have(self, effect: str) -> bool:
        """Whether it, or an effect indistinguishable from it, was found on half of the days."""
        tied = sum(count[effect] for count in self.tied.values())
        return 2 * (len(self.found.get(effect, ())) + tied) > self.days


def find_effects(rows: pl.DataFrame) -> Effects:
    """Find the effects of each joint, and how rare they are among similar joints.

    Parameters
    ----------
    rows
        The data set of a fleet (`stribeck.scale.fleet.store.SCHEMA`).
    """
    done = rows.filter(pl.col("status") == DONE)
    groups = done.group_by("robot", "joint", maintain_order=True)
    joints = [_joint(as_name(r), as_name(j), days) for (r, j), days in groups]
    having = [
        _against_peers(joint, effect, joints)
        for joint in joints
        for effect in joint.found
        if joint.has(effect)
    ]
    having.sort(key=_rarest_first)
    why = None if having else "no effect was found missing from the base model at any joint"
    return Effects(tuple(having), _shares(joints), why)


def _joint(robot: str | None, joint: str | None, days: pl.DataFrame) -> _Joint:
    found: dict[str, list[float]] = {}
    tied: dict[str, Counter[str]] = {}
    for of_day in days["found"].to_list():
        for each in of_day:
            found.setdefault(each["effect"], []).append(each["confidence"])
            tied.setdefault(each["effect"], Counter()).update(each["tied"])
    return _Joint(robot, joint, days.height, found, tied)


def _against_peers(one: _Joint, effect: str, joints: list[_Joint]) -> JointEffect:
    """Count how many peers of a joint have one of its effects."""
    peers = [other for other in joints if other.joint == one.joint and other is not one]
    if len(peers) < FEWEST_PEERS:
        peers = [other for other in joints if other is not one]
    confidences = one.found[effect]
    return JointEffect(
        one.robot,
        one.joint,
        effect,
        len(confidences),
        one.days,
        statistics.median(confidences),
        tuple(sorted(one.tied[effect])),
        len(peers),
        sum(peer.may_have(effect) for peer in peers),
    )


def _rarest_first(each: JointEffect) -> tuple[float, float, str, str, str]:
    share = each.peers_with / each.peers if each.peers else 1.0
    return share, -each.confidence, each.effect, each.robot or "", each.joint or ""


def _shares(joints: list[_Joint]) -> tuple[Share, ...]:
    """Shares by name of joint; effects that are frequent in the fleet come first."""
    names = sorted({joint.joint for joint in joints}, key=lambda name: name or "")
    counts = Counter(e for joint in joints for e in joint.found if joint.has(e))
    return tuple(
        Share(name, effect, sum(j.has(effect) for j in same), len(same))
        for name in names
        for same in [[joint for joint in joints if joint.joint == name]]
        for effect, _ in counts.most_common()
    )

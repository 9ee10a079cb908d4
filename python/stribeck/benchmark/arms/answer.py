"""What the program says of an arm, and whether it is right."""

from __future__ import annotations

import tempfile
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from stribeck.benchmark.arms.cases import RIGID, ArmCase
from stribeck.benchmark.arms.coverage import ArmIntervals, arm_intervals
from stribeck.benchmark.arms.record import arm_sample, described

#: Columns of a recording that the arms have.
CHANNELS = ("position", "velocity", "torque", "temperature")
#: What is left of an effect when base parameters hold the rest. Tooth friction is one per load,
#: and a part of the load torque that depends on the direction of power.
HELD = {"quadrant": ("load",)}


@dataclass(frozen=True)
class ArmClaim:
    """The first effect that was added to a joint.

    Attributes
    ----------
    others
        Effects from which it cannot be told.
    fall
        Of the joint's held-out error, as a share.
    """

    joint: str
    effect: str
    others: tuple[str, ...]
    fall: float


@dataclass(frozen=True)
class ArmAnswer:
    """The answer to one case.

    Attributes
    ----------
    claims
        By joints, the largest fall first.
    rigid
        Causes in the rigid bodies, best first: id, and the joint whose error falls most.
    failure
        The error, or an empty string.
    """

    case: ArmCase
    size: float = 0.0
    claims: tuple[ArmClaim, ...] = ()
    rigid: tuple[tuple[str, str], ...] = ()
    intervals: ArmIntervals | None = None
    seconds: float = 0.0
    failure: str = ""

    @property
    def expected(self) -> str:
        """What is right to say first."""
        hidden = self.case.hidden
        if self.case.group == "effect":
            return f"{hidden} on joint {self.case.joint}"
        return RIGID.get(hidden) or "nothing"

    @property
    def said(self) -> str:
        """What was said first; a cause in the rigid bodies is sought before effects."""
        if self.failure:
            return self.failure
        if self.rigid:
            return self.rigid[0][0]
        if self.claims:
            first = self.claims[0]
            return f"{' or '.join((first.effect, *first.others))} on joint {first.joint}"
        return "nothing"

    @property
    def right(self) -> bool:
        """Whether the right joint and effect, or the right cause, or nothing, comes first."""
        if self.failure:
            return False
        if self.case.group == "effect":
            first = self.claims[0] if self.claims else None
            return (
                not self.rigid
                and first is not None
                and first.joint == str(self.case.joint)
                and not {self.case.hidden, *HELD.get(self.case.hidden, ())}.isdisjoint(
                    (first.effect, *first.others)
                )
            )
        if self.case.hidden == "cable":
            return self.rigid[:1] == (("spring", str(self.case.joint)),)
        expected = RIGID.get(self.case.hidden)
        return [one for one, _ in self.rigid[:1]] == ([expected] if expected else [])

    @property
    def joints_without(self) -> tuple[int, int]:
        """Joints without a hidden effect of which none was claimed, and all of them."""
        own = str(self.case.joint) if self.case.group == "effect" else ""
        others = [str(k + 1) for k in range(6) if str(k + 1) != own]
        claimed = {claim.joint for claim in self.claims}
        return sum(joint not in claimed for joint in others), len(others)

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            **asdict(self),
            "name": self.case.name,
            "expected": self.expected,
            "said": self.said,
            "right": self.right,
        }


def arm_answer(case: ArmCase) -> ArmAnswer:
    """Simulate an arm and diagnose it; an error is part of the answer."""
    began = time.perf_counter()
    try:
        if case.group == "coverage":
            made = ArmAnswer(case, intervals=arm_intervals(case))
        else:
            made = _diagnosed(case)
    except Exception as error:  # one failed arm must not end a run of hours
        made = ArmAnswer(case, failure=f"{type(error).__name__}: {error}")
    return replace(made, seconds=time.perf_counter() - began)


def _diagnosed(case: ArmCase) -> ArmAnswer:
    from stribeck.recording.stated.options import ReadOptions
    from stribeck.robot.improve import improve_robot
    from stribeck.robot.motion import read_motion

    sample = arm_sample(case)
    reading = ReadOptions(map=["time=time", *(f"{name}={name}_{{joint}}" for name in CHANNELS)])
    with tempfile.TemporaryDirectory(prefix="stribeck-benchmark-") as folder:
        files = [str(Path(folder) / f"run_{k + 1}.parquet") for k in range(len(sample.frames))]
        for path, frame in zip(files, sample.frames, strict=True):
            frame.write_parquet(path)
        motion = read_motion(described(sample, case), files, reading)
    found = improve_robot(motion, most_steps=1)
    claims = [
        ArmClaim(
            joint,
            steps[0].finding.effect,
            steps[0].finding.indistinguishable_from,
            1.0
            - steps[0].after.relative_residual_held_out
            / steps[0].before.relative_residual_held_out,
        )
        for joint, steps in found.steps.items()
        if steps
    ]
    return ArmAnswer(
        case,
        sample.size,
        tuple(sorted(claims, key=lambda claim: -claim.fall)),
        tuple((one.cause.id, one.joints[0][0]) for one in found.rigid_body),
    )

"""What `stribeck benchmark robot` prints."""

from __future__ import annotations

from stribeck.benchmark.arms.answer import ArmAnswer
from stribeck.benchmark.arms.score import ArmScore
from stribeck.benchmark.share import Share
from stribeck.report.layout import joined, table
from stribeck.report.numbers import percent


def arm_score_text(score: ArmScore) -> str:
    """The shares with their limits, by what is hidden, and the wrong answers."""
    rows = [["", "right", "of", "share", "95 % interval", "limits", "passed"]]
    for line in score.lines:
        limits = f"{percent(line.low)} to {percent(line.high)}"
        mark = "yes" if line.passed else "NO"
        rows.append([line.title, *_share(line.share), limits, mark])
    kinds = [["hidden", "right", "of"]]
    kinds += [[name, str(share.count), str(share.total)] for name, share in score.kinds]
    wrong = [["wrong", "joint", "seed", "said first", "other claims"]]
    wrong += [_wrong(answer) for answer in score.wrong]
    return joined(
        f"{score.arms} simulated arms",
        table(rows, right=[1, 2, 3]),
        table(kinds, right=[1, 2]) if len(kinds) > 1 else "",
        table(wrong, right=[2]) if len(wrong) > 1 else "",
    )


def _share(share: Share) -> list[str]:
    low, high = share.interval
    interval = f"{100 * low:.0f} to {100 * high:.0f} %"
    return [str(share.count), str(share.total), percent(share.value), interval]


def _wrong(answer: ArmAnswer) -> list[str]:
    case = answer.case
    others = [f"{claim.effect} on {claim.joint}" for claim in answer.claims]
    joint = str(case.joint) if case.joint else ""
    return [case.hidden or case.group, joint, str(case.seed), answer.said, ", ".join(others)]

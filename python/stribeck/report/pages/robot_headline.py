"""What a page on a robot says first: which joint lacks what, in one sentence."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called
from stribeck.report.numbers import confidence_text, hedge, listed, percent

if TYPE_CHECKING:
    from stribeck.robot.compare import RobotComparison
    from stribeck.robot.diagnosis import RobotDiagnosis
    from stribeck.robot.improve import RobotImprovement
    from stribeck.robot.result import RobotFit

#: Effects that the sentence names; those after them are counted.
MOST_NAMED = 3
#: Models whose errors differ by a smaller share than this are called alike.
ALIKE = 0.05
#: An effect that joints lack: the joint, the effect, and how sure it is.
Lacking = tuple[str, str, float]


def fit_headline(found: RobotFit) -> str:
    """How much of the torque the model leaves, on the best and on the worst joint."""
    rows = sorted((one.relative_residual_held_out, one.joint) for one in found.joints)
    (least, best), (most, worst) = rows[0], rows[-1]
    between = f"{percent(least)} ({joint_called(best)}) to {percent(most)} ({joint_called(worst)})"
    if len(rows) == 1:
        between = percent(most)
    return f"On held-out data the model leaves {between} of the torque unexplained."


def comparison_headline(compared: RobotComparison) -> str:
    """On which joint the models differ most, and by how much."""
    errors = [[one.relative_residual_held_out for one in found.joints] for found in compared.fits]
    by_joint = list(zip(*errors, strict=True))
    falls = [1.0 - min(of) / max(of) for of in by_joint]
    k = max(range(len(falls)), key=falls.__getitem__)
    if len(errors) == 1:
        return fit_headline(compared.fits[0])
    if falls[k] < ALIKE:
        return f"On no joint do the held-out errors of the models differ by {100.0 * ALIKE:.0f} %."
    of = by_joint[k]
    best, worst = (compared.specs[of.index(end)] for end in (min(of), max(of)))
    joint = compared.fits[0].joints[k].joint
    return (
        f"The models differ most on {joint_called(joint)}: {best} leaves {percent(min(of))} of the "
        f"torque unexplained on held-out data, {worst} {percent(max(of))}."
    )


def improvement_headline(found: RobotImprovement) -> str:
    """What the joints lacked; where nothing was added, what their diagnoses say."""
    steps = [
        (name, step.finding.effect, step.finding.confidence)
        for name, steps in found.steps.items()
        for step in steps
    ]
    verdicts = {name: one.verdict for name, one in found.last.items()}
    return headline(steps, verdicts, [one.cause.text for one in found.rigid_body])


def diagnosis_headline(found: RobotDiagnosis) -> str:
    """What every joint lacks most."""
    firsts = [
        (name, listed([best.effect, *best.indistinguishable_from], "or"), best.confidence)
        for name, one in found.joints.items()
        for best in one.findings[:1]
    ]
    verdicts = {name: one.verdict for name, one in found.joints.items()}
    return headline(firsts, verdicts, [one.cause.text for one in found.rigid_body])


def headline(lacking: Sequence[Lacking], verdicts: dict[str, str], causes: list[str]) -> str:
    """The sentence.

    Parameters
    ----------
    verdicts
        Of the last diagnosis of each joint, for robots that lack nothing.
    causes
        What is found in the rigid bodies.

    Examples
    --------
    >>> headline([("2", "load", 0.98), ("3", "load", 0.99)], {}, [])
    'Joints 2 and 3 lack load (confidence 0.98).'
    """
    groups = _grouped(lacking)
    if groups:
        named = [_clause(k, *group) for k, group in enumerate(groups[:MOST_NAMED])]
        left = len(groups) - MOST_NAMED
        if left > 0:
            named.append(f"{left} more {'effects are' if left > 1 else 'effect is'} named below")
        said = listed(named) if left <= 0 else "; ".join(named)
    else:
        unexplained = [name for name, verdict in verdicts.items() if verdict == "unexplained"]
        said = "No effect is found to be missing from any joint"
        if unexplained:
            said += f", but structure remains on {_joints(unexplained)}"
    if causes:
        said += f"; in the rigid bodies: {listed(causes)}"
    return f"{said}."


def _grouped(lacking: Iterable[Lacking]) -> list[tuple[list[str], str, float]]:
    """The joints that lack the same effect together, with the least confidence; surest first."""
    groups: dict[tuple[str, str], list[Lacking]] = {}
    for row in lacking:
        groups.setdefault((row[1], hedge(row[2])), []).append(row)
    made = [
        ([joint for joint, _, _ in rows], effect, min(sure for _, _, sure in rows))
        for (effect, _), rows in groups.items()
    ]
    return sorted(made, key=lambda group: (-round(group[2], 2), -len(group[0])))


def _clause(place: int, joints: list[str], effect: str, confidence: float) -> str:
    """The first clause has the verb; the others share it."""
    word = hedge(confidence)
    verb = ("lack" if len(joints) > 1 else "lacks") if place == 0 else ""
    sure = confidence_text(confidence)
    number = f"confidence {sure}" if place == 0 else sure
    who = _joints(joints)
    who = f"{who[0].upper()}{who[1:]}" if place == 0 else who
    return " ".join(part for part in (who, word, verb, effect, f"({number})") if part)


def _joints(names: list[str]) -> str:
    return f"joint{'s' if len(names) > 1 else ''} {listed(names)}"

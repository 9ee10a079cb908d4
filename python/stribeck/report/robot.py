"""Whole robots as text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called, option
from stribeck.report.diagnosis import doubts
from stribeck.report.fit import HARDLY
from stribeck.report.layout import bullets, joined, paragraph, table
from stribeck.report.numbers import (
    DASH,
    MINUS,
    confidence_text,
    listed,
    percent,
    plain,
    thousands,
    unit_text,
    with_error,
)
from stribeck.report.robot_payload import drive_gains_text, payload_sentence

if TYPE_CHECKING:
    from stribeck.robot.arm import Robot
    from stribeck.robot.causes import Found
    from stribeck.robot.compare import RobotComparison
    from stribeck.robot.diagnosis import RobotDiagnosis
    from stribeck.robot.improve import RobotImprovement
    from stribeck.robot.plan import RobotPlan
    from stribeck.robot.result import Evaluated, JointFit, RobotFit

#: Base parameters that a terminal shows; the JSON has all.
MOST_ROWS = 8


def robot_text(robot: Robot) -> str:
    """The joints of a robot and what torques can show of its links."""
    from stribeck.robot.base_parameters import BaseParameters

    rows = [["joint", "kind", "on", "drive gain", "mass [kg]"]]
    for joint in robot.joints:
        carrier = "base" if joint.parent is None else robot.joints[joint.parent].name
        gain = f"{plain(joint.drive_gain, 6)} {joint.torque_unit}/A" if joint.drive_gain else DASH
        mass = DASH if joint.inertial is None else plain(float(joint.inertial[0]))
        rows.append([joint.name, joint.movement, carrier, gain, mass])
    base = BaseParameters.of(robot)
    hidden = ", ".join(base.not_shown) or "none"
    return joined(
        f"{robot.name}: {len(robot.joints)} joints",
        table(rows, right=[4]),
        coupling_text(robot),
        paragraph(
            f"Torques depend on {base.count} combinations of the links' {10 * len(robot.joints)} "
            f"inertial parameters and {len(robot.joints)} rotor inertias (base parameters).",
            0,
        ),
        paragraph(f"Without effect on any torque: {hidden}.", 0),
    )


def coupling_text(robot: Robot) -> str:
    """How motors turn with several joints; empty where each turns its own."""
    from stribeck.robot.coupled import coupled

    if not robot.coupling:
        return ""
    lines = []
    for k in coupled(robot.coupling):
        pairs = zip(robot.names, robot.coupling[k], strict=True)
        parts = [
            f"{plain(factor)} x {joint_called(name)}" for name, factor in pairs if factor != 0.0
        ]
        lines.append(f"motor of {joint_called(robot.names[k])}: {' + '.join(parts)}")
    head = f"Motors turn with several joints; recorded positions are those of the {robot.encoders}:"
    return bullets(head, lines)


def robot_fit_text(found: RobotFit) -> str:
    """Errors of each joint, friction, base parameters and what they say of the links."""
    balance = found.solved.balance
    runs = balance.run_names
    from_runs = f"{len(runs)} runs" if len(runs) > 1 else "1 run"
    return joined(
        f"{balance.base.robot.name}: {len(found.joints)} joints, {thousands(balance.rows)} "
        f"samples, {from_runs}; low-pass {balance.motion.cutoff:.3g} Hz on both sides",
        errors_text(found.joints, found.ordinary, balance.held_out),
        friction_text(found.joints),
        _base_text(found),
        paragraph(bodies_sentence(found), 0),
        ""
        if found.payload is None
        else paragraph(payload_sentence(found.payload, found.drive_gains), 0),
        drive_gains_text(found.drive_gains),
        *(evaluated_text(found.joints, row) for row in found.evaluated),
    )


def bodies_sentence(found: RobotFit) -> str:
    """Whether links that can exist have the identified base parameters, if these say anything."""
    unknown = [one.joint for one in found.joints if one.relative_residual_held_out > HARDLY]
    if unknown:
        cutoff = found.solved.balance.motion.cutoff
        joints = listed([joint_called(name) for name in unknown])
        return (
            f"The model explains hardly any of the torque of {joints}, so that the base parameters "
            f"say nothing about the links. Try a lower cut-off than {cutoff:.3g} Hz with "
            f"{option('cutoff')}: above the band of the motion, elasticity and the time between "
            f"the channels matter. Otherwise a joint, a unit or a sign is wrong."
        )
    if found.consistent:
        return "Bodies of positive mass density have these base parameters."
    return (
        "No bodies of positive mass density have these base parameters: the nearest ones are "
        f"{found.bodies.deviation:.1f} standard errors away."
    )


def errors_rows(joints: Sequence[JointFit], ordinary: Sequence[JointFit]) -> list[list[str]]:
    """The errors of each joint beside those of the ordinary model; the heading first."""
    rows = [["joint", "model", "held-out RMSE", "unit", "relative", "ordinary", "ratio"]]
    for mine, other in zip(joints, ordinary, strict=True):
        relative, before = mine.relative_residual_held_out, other.relative_residual_held_out
        rmse = f"{plain(mine.rmse_held_out)}"
        unit = mine.model.torque_unit
        ratio = f"{relative / before:.2f}"
        rows.append(
            [mine.joint, mine.model.spec, rmse, unit, percent(relative), percent(before), ratio]
        )
    return rows


def errors_legend(held_out: str) -> str:
    """What the columns of the errors mean."""
    return (
        f"relative: held-out residual over torque, both filtered; held out by {held_out}. "
        "ordinary: the same with Coulomb and viscous friction and a constant on each joint."
    )


def errors_text(joints: Sequence[JointFit], ordinary: Sequence[JointFit], held_out: str) -> str:
    """The errors of each joint beside those of the ordinary model."""
    rows = table(errors_rows(joints, ordinary), right=[2, 4, 5, 6])
    return joined(rows, paragraph(errors_legend(held_out), 2))


def friction_text(joints: Sequence[JointFit]) -> str:
    """The friction parameters of all joints."""
    rows = [["joint", "parameter", "value", "error", "unit", ""]]
    for joint in joints:
        for k, e in enumerate(joint.estimates.values()):
            value, error = with_error(e.value, e.stderr)
            flag = "at its bound" if e.at_bound else "" if e.identifiable else "not identifiable"
            name = joint.joint if k == 0 else ""
            rows.append(
                [
                    name,
                    e.name,
                    value,
                    f"± {error}" if error else "",
                    unit_text(e.unit),
                    flag,
                ]
            )
    return table(rows, right=[2])


def base_rows(found: RobotFit, most: int | None = None) -> list[list[str]]:
    """Base parameters, the most certain first; the heading before them."""
    shown = sorted(found.base_parameters, key=lambda b: b.stderr / (abs(b.value) or 1e-300))
    rows = [["base parameter", "value", "error", "unit"]]
    for row in shown[:most]:
        value, error = with_error(row.value, row.stderr)
        combination = row.combination.replace(" - ", f" {MINUS} ")
        rows.append([combination, value, f"± {error}", row.unit])
    return rows


def _base_text(found: RobotFit) -> str:
    heading, *rows = base_rows(found, MOST_ROWS)
    cut = [[text if len(text) < 60 else f"{text[:57]}...", *rest] for text, *rest in rows]
    left = len(found.base_parameters) - MOST_ROWS
    more = f"  and {left} more, less certain: --json has all" if left > 0 else ""
    return table([heading, *cut], right=[1]) + (f"\n{more}" if more else "")


def evaluated_rows(joints: Sequence[JointFit], row: Evaluated) -> list[list[str]]:
    """Errors on a recording that nothing was fitted to; the heading first."""
    rows = [["joint", "relative", "ordinary", "ratio"]]
    for joint, mine, other, ratio in zip(
        joints, row.relative_residual, row.ordinary, row.ratio, strict=True
    ):
        rows.append([joint.joint, percent(mine), percent(other), f"{ratio:.2f}"])
    return rows


def evaluated_text(joints: Sequence[JointFit], row: Evaluated) -> str:
    """Errors on a recording that nothing was fitted to."""
    rows = table(evaluated_rows(joints, row), right=[1, 2, 3])
    return f"{Path(row.path).name}, not fitted:\n{rows}"


def robot_comparison_text(compared: RobotComparison) -> str:
    """Relative errors, one column a model."""
    rows = [["joint", *compared.specs]]
    for k, joint in enumerate(compared.fits[0].joints):
        errors = [percent(found.joints[k].relative_residual_held_out) for found in compared.fits]
        rows.append([joint.joint, *errors])
    columns = range(1, len(compared.specs) + 1)
    legend = (
        "Held-out residual over torque, both filtered; held out by "
        f"{compared.fits[0].solved.balance.held_out}."
    )
    evaluated = [
        f"{Path(row.path).name}, not fitted, {spec}: "
        + ", ".join(percent(error) for error in row.relative_residual)
        for spec, found in zip(compared.specs, compared.fits, strict=True)
        for row in found.evaluated
    ]
    return joined(table(rows, right=columns), paragraph(legend), "\n".join(evaluated))


def robot_diagnosis_text(found: RobotDiagnosis) -> str:
    """What each joint lacks, and causes in the rigid bodies."""
    return joined(
        table(lacking_rows(found), right=[3]),
        *_doubts_of_joints(found),
        causes_text(found.rigid_body),
        ""
        if found.fit.payload is None
        else paragraph(payload_sentence(found.fit.payload, found.fit.drive_gains), 0),
    )


def lacking_rows(found: RobotDiagnosis) -> list[list[str]]:
    """What each joint lacks; the heading first."""
    rows = [["joint", "model", "lacks", "held-out RMSE", "unit", "confidence"]]
    for name, joint in found.joints.items():
        first = joint.findings[0] if joint.findings else None
        if first is None:
            said = "nothing that passes" if joint.verdict == "none" else "nothing; unexplained"
            rows.append([name, joint.fit.model.spec, said, "", "", ""])
            continue
        before, after = plain(first.rmse_held_out_before), plain(first.rmse_held_out_after)
        unit = joint.fit.model.torque_unit
        others = "".join(f" or {other}" for other in first.indistinguishable_from)
        lacks = f"{first.effect}{others}"
        spec, sure = joint.fit.model.spec, confidence_text(first.confidence)
        rows.append([name, spec, lacks, f"{before} → {after}", unit, sure])
    return rows


def _doubts_of_joints(found: RobotDiagnosis) -> list[str]:
    """Effects of each joint that lower the held-out error, but are demoted or not claimed."""
    rows: dict[str, list[str]] = {}
    for name, joint in found.joints.items():
        for heading, sentences in doubts(joint):
            rows.setdefault(heading, []).extend(
                f"{joint_called(name)}, {text}" for text in sentences
            )
    return [bullets(f"{heading}:", sentences) for heading, sentences in rows.items()]


#: What is said where nothing is found in the rigid bodies.
NO_CAUSES = (
    "Rigid bodies: no payload, spring, coupled rotor or motor, or tilt of the base lowers the "
    "held-out error significantly."
)


def causes_rows(found: Sequence[Found]) -> list[list[str]]:
    """Causes in the rigid bodies, best first; the heading before them."""
    rows = [["in the rigid bodies", "error of all joints", "most on joint", "confidence"]]
    for one in found:
        joint, fall = one.joints[0]
        error = f"{one.before:.3f} → {one.after:.3f}"
        rows.append(
            [one.cause.text, error, f"{joint} ({percent(fall)} less)", percent(one.confidence)]
        )
    return rows


def causes_text(found: Sequence[Found]) -> str:
    """Causes in the rigid bodies, best first."""
    return table(causes_rows(found)) if found else paragraph(NO_CAUSES, 0)


def added_rows(found: RobotImprovement) -> list[list[str]]:
    """The effects added to each joint; the heading first."""
    rows = [["joint", "added", "held-out RMSE", "unit", "relative", "confidence"]]
    for name, steps in found.steps.items():
        for step in steps:
            before, after = step.before, step.after
            rmse = f"{plain(before.rmse_held_out)} → {plain(after.rmse_held_out)}"
            relative = (
                f"{percent(before.relative_residual_held_out)} → "
                f"{percent(after.relative_residual_held_out)}"
            )
            unit = after.model.torque_unit
            sure = confidence_text(step.finding.confidence)
            rows.append([name, step.finding.effect, rmse, unit, relative, sure])
    return rows


def robot_improvement_text(found: RobotImprovement) -> str:
    """The effects added to each joint, and the robot with them."""
    rows = added_rows(found)
    added = table(rows, right=[2, 4]) if len(rows) > 1 else "No effect is added."
    where = [
        paragraph(f"{joint_called(name)}, {step.finding.effect}: {step.finding.where}.", 2, 2)
        for name, steps in found.steps.items()
        for step in steps
    ]
    return joined(
        f"Improving {found.base.solved.balance.base.robot.name}",
        added,
        "\n".join(where),
        found_alone(found),
        causes_text(found.rigid_body),
        robot_fit_text(found.final),
    )


def found_alone(found: RobotImprovement) -> str:
    """Effects that the last diagnosis of a joint finds, and that were not added."""
    left = [
        f"{joint_called(name)}: {listed([finding.effect for finding in joint.findings], 'or')}"
        for name, joint in found.last.items()
        if joint.findings
    ]
    heading = "Found on the joint alone, and not added:"
    return bullets(heading, left) if left else ""


def robot_plan_text(plan: RobotPlan) -> str:
    """The extent of a planned motion, and what it gains."""
    return joined(
        plan_sentence(plan),
        table(plan_rows(plan), right=[1, 2, 4, 5, 6, 7]),
        paragraph(gain_sentence(plan), 0),
    )


def plan_sentence(plan: RobotPlan) -> str:
    """The robot, and how long the motion is."""
    return f"{plan.robot.name}: {plan.time[-1]:.3g} s, {len(plan.time)} samples"


def plan_rows(plan: RobotPlan) -> list[list[str]]:
    """The extent of each joint's motion; the heading first."""
    rows = [["joint", "from", "to", "", "speed", "acceleration", "torque", "limit"]]
    for k, joint in enumerate(plan.robot.joints):
        q, v, a = (x[:, k] for x in (plan.position, plan.velocity, plan.acceleration))
        unit = "rad" if joint.movement == "revolute" else "m"
        sizes = (float(q.min()), float(q.max()), float(abs(v).max()), float(abs(a).max()))
        low, high, speed, bend = (f"{size:.2f}" for size in sizes)
        torque = (
            "" if plan.torque is None else f"{plain(float(plan.torque[k]))} {joint.torque_unit}"
        )
        largest = plain(joint.torque_limit) if joint.torque_limit else ""
        moves = [f"{speed} {unit}/s", f"{bend} {unit}/s2"]
        rows.append([joint.name, low, high, unit, *moves, torque, largest])
    return rows


def gain_sentence(plan: RobotPlan) -> str:
    """What the motion gains, and what is known of torques and collisions."""
    return f"{_gain(plan)} {_checked(plan)}"


def _gain(plan: RobotPlan) -> str:
    if plan.gain is None:
        return "Too few random motions are within these limits for a gain to be stated."
    return (
        f"Standard errors of the {plan.parameters} base and friction parameters are smaller than "
        "on a random motion within the same limits by a factor of "
        f"{plan.gain:.2f} (geometric mean)."
    )


def _checked(plan: RobotPlan) -> str:
    """What is known of torques and collisions."""
    limited = any(joint.torque_limit for joint in plan.robot.joints)
    torque = (
        "Torques of the rigid bodies are within their limits; friction comes on top."
        if limited
        else "Torques are not limited."
    )
    apart = (
        f"Spheres of links stay {100.0 * plan.clearance:.1f} cm apart."
        if plan.robot.spheres
        else "Collisions are not checked."
    )
    return f"{torque} {apart}"

"""The files of a robot in Rust."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

from stribeck.exporters.robot.joints import OF_MOTION, Joints
from stribeck.exporters.robot.vectors import RobotVectors
from stribeck.exporters.rust.files import literal
from stribeck.exporters.templates import template


def robot_rust_files(joints: Joints, vectors: RobotVectors, *, name: str) -> Mapping[str, str]:
    """A module with the robot as constants and its test, by file name.

    The module needs the crate `stribeck`, without its default features if there is no `std`.
    """

    def number(x: float) -> str:
        return literal(x, joints.precision)

    laws = [
        {
            "law": model.core.law,
            "by_formula": model.by_formula,
            "formulas": [terms.text for terms in model.own],
            "effects": [*model.effects, *model.rigid_body],
            "constants": sorted(model.core.constants.items()),
            "parameters": [
                (p.name, p.unit, number(value))
                for p, value in zip(model.parameters, model.values, strict=True)
            ],
        }
        for model in joints.friction
    ]
    text = template("rust", "robot.rs.j2").render(
        about=[
            line
            for paragraph in joints.about()
            for line in textwrap.wrap(paragraph, 96, subsequent_indent="    ") or [""]
        ],
        real=joints.precision,
        joints=joints.robot.joints,
        gravity=joints.robot.gravity,
        turns=joints.robot.coupling,
        inverse=joints.robot.core.joints_per_motor,
        laws=laws,
        channels=[*OF_MOTION[:3], *joints.given],
        rows=[[number(x) for x in row] for row in vectors.rows],
        literal=number,
        numbers=lambda row: ", ".join(number(x) for x in row),
    )
    return {f"{name}.rs": text}

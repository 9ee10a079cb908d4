"""Export as MJCF: the friction that a joint of MuJoCo has."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping

from stribeck.base.errors import SpecError
from stribeck.exporters.about import About
from stribeck.models.model import Model

#: Attributes of a joint in MJCF, and the parameters that they are.
ATTRIBUTES = {"damping": "viscous_friction", "frictionloss": "coulomb_friction"}


def left_out(model: Model) -> tuple[str, ...]:
    """Parts of a model that a joint of MuJoCo does not have.

    Examples
    --------
    >>> from stribeck.models.model import Model
    >>> left_out(Model("coulomb", effects=("load", "delay")))
    ('load', 'delay')
    """
    law = () if model.law == "coulomb" else (f"what {model.law} has besides",)
    return (*law, *model.own_effects, *model.effects, *model.rigid_body)


def mujoco_files(about: About, *, name: str) -> Mapping[str, str]:
    """One MJCF document with a default class, by file name.

    Raises
    ------
    SpecError
        The model has neither Coulomb nor viscous friction, or no unit of torque.
    """
    model = about.model
    found = {key: x for key, x in ATTRIBUTES.items() if x in model.names}
    if not found:
        raise SpecError(
            f"a joint of MuJoCo has Coulomb and viscous friction, and {model.spec} has neither by "
            "name: fit coulomb to the same data, and export that"
        )
    if model.torque_unit not in ("N m", "N"):
        raise SpecError(
            f"a joint of MuJoCo has a torque, and {model.spec} is in {model.torque_unit}: give "
            "what the torque is made of when it is fitted"
        )
    root = ET.Element("mujoco", model=name)
    for line in about.origin():
        root.append(ET.Comment(f" {line.replace('--', '- -')} "))
    if left := left_out(model):
        root.append(ET.Comment(f" Left out, as MuJoCo has no such term: {', '.join(left)}. "))
    usual = ET.SubElement(root, "default")
    own = ET.SubElement(usual, "default", {"class": name})
    ET.SubElement(own, "joint", {key: repr(float(model.value(x))) for key, x in found.items()})
    ET.indent(root)
    return {f"{name}.xml": ET.tostring(root, encoding="unicode") + "\n"}

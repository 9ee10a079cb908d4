"""Five made robots as URDF: serial arms, sliding joints, skew axes, a tree, fixed links."""

from __future__ import annotations

import numpy as np

KINDS = {
    "six_revolute": ("rrrrrr", "chain"),
    "scara": ("rrpr", "chain"),
    "stanford": ("rrprrr", "chain"),
    "seven_revolute": ("rrrrrrr", "chain"),
    "two_arms": ("rrrprr", "tree"),
}


def urdf(name: str) -> str:
    """A URDF; the numbers follow from the name alone."""
    kinds, shape = KINDS[name]
    random = np.random.default_rng(sum(map(ord, name)))
    parts = [f'<robot name="{name}">', '<link name="base"/>']
    for k, kind in enumerate(kinds):
        parent = "base" if k == 0 else f"link_{k - 1}"
        if shape == "tree" and k == 3:
            parent = "link_0"
        parts += _joint(f"joint_{k}", kind, parent, f"link_{k}", random)
        parts += _link(f"link_{k}", random)
    parts += _joint("flange", "f", f"link_{len(kinds) - 1}", "tool", random)
    parts += [*_link("tool", random), "</robot>"]
    return "\n".join(parts)


def _numbers(values: np.ndarray) -> str:
    return " ".join(f"{x:.4f}" for x in values)


def _joint(name: str, kind: str, parent: str, child: str, random: np.random.Generator) -> list[str]:
    axis = random.normal(size=3)
    if kind == "r" and random.uniform() < 0.5:
        axis = np.array([0.0, 0.0, 1.0])
    types = {"r": "revolute", "p": "prismatic", "f": "fixed"}
    return [
        f'<joint name="{name}" type="{types[kind]}">',
        f'<parent link="{parent}"/><child link="{child}"/>',
        f'<origin xyz="{_numbers(random.uniform(-0.5, 0.5, 3))}" '
        f'rpy="{_numbers(random.uniform(-3, 3, 3))}"/>',
        f'<axis xyz="{_numbers(axis)}"/>',
        '<limit lower="-3" upper="3" effort="100" velocity="3"/></joint>',
    ]


def _link(name: str, random: np.random.Generator) -> list[str]:
    root = random.uniform(-0.1, 0.1, (3, 3))
    i = root @ root.T + 0.02 * np.eye(3)
    mass = random.uniform(0.5, 8.0)
    return [
        f'<link name="{name}"><inertial><mass value="{mass:.4f}"/>',
        f'<origin xyz="{_numbers(random.uniform(-0.2, 0.2, 3))}" '
        f'rpy="{_numbers(random.uniform(-3, 3, 3))}"/>',
        f'<inertia ixx="{i[0, 0]:.6f}" ixy="{i[0, 1]:.6f}" ixz="{i[0, 2]:.6f}" '
        f'iyy="{i[1, 1]:.6f}" iyz="{i[1, 2]:.6f}" izz="{i[2, 2]:.6f}"/></inertial></link>',
    ]


def states(name: str, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, velocities and accelerations [count, N]."""
    joints = len(KINDS[name][0])
    position, velocity, acceleration = np.random.default_rng(7).uniform(-2, 2, (3, count, joints))
    return position, velocity, acceleration

"""Friction compensation and direct teaching, hot and loaded: print the README's figures.

python tests/studies/compensation.py [FIGURE.png]

The experiments of Tadese et al. 2021, section V-B, on joint 2 of
tests/python/fitting/methods/indy.py.
Its friction is known only to what moves it: the comprehensive model is identified by three steps
on noisy recordings of it, LuGre on noisy points without load at room temperature.
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import polars as pl
import stribeck as sb
from stribeck.base.files import save_figure
from stribeck.fitting.methods.three_step import three_step_fit
from stribeck.fitting.result import Fit
from stribeck.motion.compensate.factor import Factor, largest_factor
from stribeck.motion.compensate.loop import Compensator
from stribeck.motion.compensate.teaching import Guidance, Teaching, teach
from stribeck.motion.compensate.tracking import compensate as follow
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Quintic, Trapezoid

sys.path.append(str(Path(__file__).resolve().parents[1] / "python/fitting/methods"))
import indy

#: degC.
ROOM, HOT = 27.0, 50.0
#: The payload of the paper, kg, and its distance from the joint, m.
PAYLOAD, REACH = 6.66, 0.6
#: The arm's own gravity torque when it is level, N m.
ARM_GRAVITY = 16.0
#: From -90 to 90 degrees; speeds in rad/s: of tracking, and 34 deg/s of the hand.
START, END, SPEED, HAND_SPEED = -math.pi / 2, math.pi / 2, 1.2, math.radians(34.0)
#: Over which the largest factor is proved: what the identification covered.
BOX = {"velocity": (-1.8, 1.8), "temperature": (20.0, 60.0), "load_torque": (-60.0, 60.0)}
#: Of the friction observer, Hz.
OBSERVER = 5.0
QUADRANTS = {
    (1, 1): "forward_motoring",
    (-1, 1): "backward_generating",
    (-1, -1): "backward_motoring",
    (1, -1): "forward_generating",
}
LOAD_NAMES = ("load_rise", "load_rise_rate", "load_jump", "load_friction", "load_viscous")
VISCOUS_NAMES = (
    "viscous_level",
    "viscous_level_slope",
    "viscous_speed",
    "viscous_speed_slope",
)


def truth() -> sb.Model:
    """The joint's friction."""
    values = dict(zip(("bristle_stiffness", "bristle_damping"), indy.JOINT_2, strict=True))
    values["damping_velocity"] = indy.DAMPING_VELOCITY
    for word, way in (("forward", 1), ("backward", -1)):
        values[f"coulomb_friction_{word}"] = indy.COULOMB[way]
        for name, value in zip(VISCOUS_NAMES, indy.VISCOUS[way], strict=True):
            values[f"{name}_{word}"] = value
    for signs, quadrant in QUADRANTS.items():
        for name, value in zip(LOAD_NAMES, indy.LOAD[signs], strict=True):
            values[f"{name}_{quadrant}"] = value
    return sb.model("tadese_full", **values)


def joint(payload: float) -> Joint:
    """The joint with a payload (kg); gravity changes its sign half way."""
    gravity = ARM_GRAVITY + 9.81 * payload * REACH
    return Joint.revolute(indy.INERTIA + payload * REACH**2, gravity_sin=gravity)


def read(frame: pl.DataFrame, folder: Path, name: str, **options: object) -> sb.Recording:
    """A recording of the joint."""
    path = folder / f"{name}.csv"
    frame.write_csv(path)
    return sb.read(path, joint_kind="revolute", **options)


def identified() -> tuple[Fit, Fit]:
    """The comprehensive model, and LuGre."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        full = three_step_fit(
            "tadese_full",
            read(indy.no_load_points(), folder, "no_load", average="run"),
            read(indy.loaded_points(), folder, "loaded", average="run"),
            read(indy.presliding_log(), folder, "presliding", standstill=True),
        )
        cold = indy.points([(v, ROOM, 0.0) for v in indy.SPEEDS], seed=4)
        # Steady sliding does not show the bristle: it is that of the presliding experiment.
        bristle = {n: full.model.value(n) for n in ("bristle_stiffness", "bristle_damping")}
        lugre = sb.fit("lugre", read(cold, folder, "cold", average="run"), fix=bristle)
    return full, lugre


def print_tracking(friction: sb.Model, models: Sequence[tuple[str, Fit]], figure: str) -> None:
    """Tracking errors, hot and loaded."""
    path = Quintic(START, END, 1.875 * (END - START) / SPEED)
    with_models = [Compensator(fit.model, name=name) for name, fit in models]
    ahead = [Compensator(fit.model, feedback=False, name=name) for name, fit in models]
    arm = joint(PAYLOAD)
    seen = {"temperature": HOT, "encoder": indy.ENCODER}
    alone = follow(friction, arm, path, [*with_models, *ahead], **seen)
    observed = follow(friction, arm, path, with_models, **seen, observer=OBSERVER)
    print(f"| hot ({HOT:g} degC) and loaded ({PAYLOAD:g} kg) | from | RMSE | largest | RMSE by |")
    print("|---|---|---|---|---|")
    for result, beside in ((alone, ""), (observed, ", friction observer")):
        for motion in result.motions:
            source = "-"
            if motion.compensator is not None:
                source = "measured" if motion.compensator.feedback else "desired"
            change = 100.0 * (motion.rmse / alone.motions[0].rmse - 1.0)
            print(
                f"| {motion.name}{beside} | {source} | {1e3 * motion.rmse:.3g} mrad | "
                f"{1e3 * motion.largest_error:.3g} mrad | {change:+.0f} % |"
            )
    lugre, full = alone.motions[1], alone.motions[2]
    print(f"\nfull model below LuGre: RMSE {100.0 * (full.rmse / lugre.rmse - 1.0):+.0f} %")
    if figure:
        shown = follow(friction, arm, path, with_models, **seen)
        save_figure(shown.plot(), figure)


def print_factors(models: Sequence[tuple[str, Fit]], full: Fit) -> list[Factor]:
    """The largest factors."""
    factors = []
    print("\n| largest factor | proved | where more could overcompensate |")
    print("|---|---|---|")
    for name, fit in models:
        factor = largest_factor(fit, full, BOX)
        factors.append(factor)
        at = (
            ""
            if factor.point is None
            else ", ".join(f"{side} {factor.point[side]:.3g}" for side in factor.box)
        )
        print(f"| {name} | {factor.value:.3f} | {at} |")
    return factors


def print_teaching(friction: sb.Model, compensators: Sequence[Compensator]) -> Teaching:
    """What the hand has to give at room temperature, and whether it is safe when hot."""
    path = Trapezoid(START, END, HAND_SPEED, 2.0)
    arm = joint(0.0)
    hand = Guidance.with_bandwidth(path, arm.inertia)
    cold, hot = (
        teach(friction, arm, hand, compensators, temperature=warmth, encoder=indy.ENCODER)
        for warmth in (ROOM, HOT)
    )
    print("\n| direct teaching | alpha | hand, RMS | largest | exceeds friction when hot |")
    print("|---|---|---|---|---|")
    for motion, warm in zip(cold.motions, hot.motions, strict=True):
        rms, largest = cold.interaction(motion)
        alpha = 0.0 if motion.compensator is None else motion.compensator.factor
        print(
            f"| {motion.name} | {alpha:.2f} | {rms:.3g} N m | {largest:.3g} N m | "
            f"{100.0 * hot.overcompensated(warm):.2g} % of the time |"
        )
    return cold


def main() -> None:
    """Print the tables; draw the tracking errors."""
    friction = truth()
    full, lugre = identified()
    models = [("LuGre", lugre), ("full model", full)]
    print_tracking(friction, models, sys.argv[1] if len(sys.argv) > 1 else "")
    factors = print_factors(models, full)
    names = [name for name, _ in models]
    paper = [
        Compensator(fit.model, a, name=f"{name}, as in the paper")
        for (name, fit), a in zip(models, (0.35, 0.85), strict=True)
    ]
    proved = [
        Compensator(fit.model, f.value, name=f"{name}, proved")
        for (name, fit), f in zip(models, factors, strict=True)
    ]
    taught = print_teaching(friction, [*paper, *proved])
    rms = np.array([taught.interaction(motion)[0] for motion in taught.motions[1:]])
    for title, (simple, comprehensive) in (("as in the paper", rms[:2]), ("proved", rms[2:])):
        change = 100.0 * (comprehensive / simple - 1.0)
        print(f"\n{title}: hand's torque with {names[1]} against {names[0]} {change:+.0f} %")


if __name__ == "__main__":
    main()

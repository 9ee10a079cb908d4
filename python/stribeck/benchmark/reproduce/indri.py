"""Indri et al.: static LuGre and cubic friction of a direct-drive planar arm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.benchmark.reproduce import indri_figures as draw
from stribeck.benchmark.reproduce.result import Reproduction, Row, last_digit
from stribeck.fitting.fit import fit
from stribeck.fitting.methods.arm import ArmFit, arm_fit, friction_columns, rigid_body_columns
from stribeck.fitting.methods.trajectory import FOUR_HARMONICS
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.models.model import Model
from stribeck.models.published.sets import published
from stribeck.recording.load import read

Array = NDArray[np.float64]

#: Length of the first link: half of the 0.7 m of both; the paper does not print it.
FIRST_LINK = 0.35
#: Eqs 14 and 15: kg m2, kg m, kg m, kg m2, then a0 to a3 of both joints.
ESTIMATED = "3.6457 0.9836 -0.0012 0.2857 6.8406 2.6236 -1.1580 0.4680 2.3512 0.3069 -0.3374 0.1252"
NOMINAL = (3.689, 0.97, 0.0, 0.275)
#: Relative errors on the identification, and on the circle with LuGre and with the polynomial, %.
IDENTIFIED, CIRCLE_LUGRE, CIRCLE_CUBIC = (31.8, 31.7), (35.8, 45.9), (33.1, 39.9)
#: Speeds of the tests at constant velocity, rad/s, and the RMS error of a point, N m.
SPEEDS, POINT_NOISE = np.geomspace(0.02, 3.0, 40), (0.10, 0.03)
#: The circle: centre and radius [m], period [s] and turns; the paper does not print them.
CENTRE, RADIUS, PERIOD, TURNS = (0.45, 0.0), 0.12, 4.0, 3
#: Samples of a repetition, and the time over which the torque error is correlated, s.
ROWS, REPETITIONS, MEMORY = 2500, 10, 0.1


@dataclass(frozen=True)
class ArmMotion:
    """Times and both joints' angles, velocities, accelerations and torques, arrays [n, 2]."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    torque: Array


def reproduce(seed: int = 0, quick: bool = False) -> Reproduction:
    """Repeat table 1, eq 14, the relative errors, and figures 3 to 8."""
    static = [_static(joint, seed) for joint in (1, 2)]
    repetitions = 3 if quick else REPETITIONS
    runs = [_identification(seed, k) for k in range(repetitions)]
    arm = _arm_fit(runs)
    circle = _circle(seed)
    lugre = _rebuilt(circle, np.array(NOMINAL), [f.model for f in static])
    cubic = _rebuilt(circle, arm.values[:4], [arm.friction(k) for k in (1, 2)])
    first = runs[0]
    again = _rebuilt(first, arm.values[:4], [arm.friction(k) for k in (1, 2)])
    return Reproduction(
        paper="indri",
        title="Nonlinear friction estimation for digital control of direct-drive manipulators",
        source="Indri et al.",
        data=_DATA,
        left_out=("figures 1 and 2: drawings of the arm and of its controller",),
        rows=(
            *(row for joint, f in enumerate(static, 1) for row in _table_rows(joint, f)),
            *_theta_rows(arm),
            *_error_rows("section 4.2", "identification", IDENTIFIED, arm.relative_errors, _NOISE),
            *_error_rows(
                "section 4.3", "circle, LuGre", CIRCLE_LUGRE, _relative(circle, lugre), _CIRCLE
            ),
            *_error_rows(
                "section 4.3", "circle, polynomial", CIRCLE_CUBIC, _relative(circle, cubic), _CIRCLE
            ),
        ),
        pictures=(
            *draw.static_friction(static[0]),
            draw.trajectory(first.time, first.position),
            draw.rebuilt(6, "four-harmonic trajectory", first.time, first.torque, again),
            draw.rebuilt(7, "circle, static LuGre", circle.time, circle.torque, lugre),
            draw.rebuilt(8, "circle, polynomial", circle.time, circle.torque, cubic),
        ),
    )


#: Share of a printed relative error that ours may differ by, and why.
_NOISE = (
    0.1,
    "the torque error is simulated with the printed share; its correlation leaves 10 % to chance",
)
_CIRCLE = (
    0.5,
    "the torque error has the size of the identification; speed and radius of the circle, which "
    "are not printed, set the torque that it is divided by, and with it a half of the figure",
)
_DATA = (
    "The paper publishes no measurements. The arm is simulated with eq 14: four inertial "
    "parameters and cubic friction; tests at constant velocity with table 1.",
    "What the printed models do not explain is simulated as an error of the torque with the "
    f"printed relative RMS of section 4.2, correlated over {MEMORY:g} s as the peaks at reversals "
    "are.",
    f"Not printed, and chosen: the first link, {FIRST_LINK} m; speeds of the tests, {SPEEDS[0]:g} "
    f"to {SPEEDS[-1]:g} rad/s with {POINT_NOISE[0]:g} and {POINT_NOISE[1]:g} N m of noise; the "
    f"circle, radius {RADIUS} m about ({CENTRE[0]}, {CENTRE[1]}) m in {PERIOD:g} s.",
    "Signs as printed: in all four columns of table 1, alpha_3 and alpha_4 drive the motion. "
    "Friction of joint 1 falls beyond 0.8 rad/s and would change its sign above 5 rad/s; eq 14's "
    "viscous coefficients are positive. A sign may have been lost in print.",
    "Eq 12 lists 14 parameters and eq 14 prints 12: the two a4 do not exist in eq 10. Table 1's "
    "speeds omega_s1 and omega_s2 are chosen in the paper, and held here.",
)


def _static(joint: int, seed: int) -> Fit:
    """Section 4.1: the coefficients of table 1 by least squares, with the speeds held."""
    rng = np.random.default_rng([seed, joint])
    truth = published(f"indri/table_1/joint_{joint}/indri_static")
    v = np.concatenate([SPEEDS, -SPEEDS])
    torque = truth.torque(v) + POINT_NOISE[joint - 1] * rng.standard_normal(v.size)
    points = {"run": np.arange(v.size), "velocity": v, "friction_torque": torque}
    held = {p.symbol: truth.value(p.name) for p in truth.parameters if p.symbol.startswith("w")}
    recording = read(points, average="run", joint_kind="revolute")
    return fit("indri_static", recording, fix=held, starts=1)


def _theta() -> Array:
    return np.array([float(text) for text in ESTIMATED.split()])


def _model_torque(position: Array, velocity: Array, acceleration: Array) -> Array:
    """Torque of both joints with eq 14, N m, array [n, 2]."""
    theta = _theta()
    torque = rigid_body_columns(position, velocity, acceleration, FIRST_LINK) @ theta[:4]
    for k in range(2):
        torque[:, k] += friction_columns(velocity[:, k]) @ theta[4 * (k + 1) : 4 * (k + 2)]
    return torque


def _error(rows: int, dt: float, seed: list[int]) -> Array:
    """A correlated error of both joints with the printed share of the identification's torque."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, FOUR_HARMONICS.seconds, ROWS, endpoint=False)
    usual = [rms(column) for column in _model_torque(*FOUR_HARMONICS(time)).T]
    wide = max(1, round(MEMORY / dt))
    kernel = np.ones(wide) / np.sqrt(wide)
    white = rng.standard_normal((rows + wide - 1, 2))
    made = np.column_stack([np.convolve(white[:, k], kernel, mode="valid") for k in range(2)])
    shares = np.array(IDENTIFIED) / 100.0
    # The measured torque contains the error: its share is of both together.
    return made * np.array(usual) * shares / np.sqrt(1.0 - shares**2)


def _identification(seed: int, run: int) -> ArmMotion:
    time = np.linspace(0.0, FOUR_HARMONICS.seconds, ROWS, endpoint=False)
    motion = FOUR_HARMONICS(time)
    error = _error(ROWS, FOUR_HARMONICS.seconds / ROWS, [seed, 20, run])
    return ArmMotion(time, *motion, _model_torque(*motion) + error)


def _circle(seed: int) -> ArmMotion:
    """Section 4.3: the tip on a circle; angles by inverse kinematics of two equal links."""
    time = np.arange(0.0, PERIOD * TURNS, 2e-3)
    phase = 2.0 * np.pi * time / PERIOD
    x, y = CENTRE[0] + RADIUS * np.cos(phase), CENTRE[1] + RADIUS * np.sin(phase)
    reach = np.hypot(x, y)
    bend = 2.0 * np.arccos(reach / (2.0 * FIRST_LINK))
    position = np.column_stack([np.arctan2(y, x) - bend / 2.0, bend])
    velocity = np.gradient(position, time, axis=0)
    acceleration = np.gradient(velocity, time, axis=0)
    torque = _model_torque(position, velocity, acceleration)
    torque = torque + _error(time.size, 2e-3, [seed, 30])
    return ArmMotion(time, position, velocity, acceleration, torque)


def _arm_fit(runs: list[ArmMotion]) -> ArmFit:
    """Section 4.2: least squares of the repetitions together."""
    frames = [
        pl.DataFrame({"run": k, "time": run.time}).with_columns(
            pl.Series(f"{name}_{joint + 1}", values[:, joint])
            for name, values in (("q", run.position), ("torque", run.torque))
            for joint in range(2)
        )
        for k, run in enumerate(runs, 1)
    ]
    table = pl.concat(frames)
    first, second = (read(table, joint=joint, joint_kind="revolute") for joint in ("1", "2"))
    return arm_fit(first, second, first_link_length=FIRST_LINK, slowest=0.0, weighted=False)


def _rebuilt(motion: ArmMotion, inertial: Array, friction: list[Model]) -> Array:
    """Torque rebuilt from inertial parameters and both frictions, N m, array [n, 2]."""
    columns = rigid_body_columns(motion.position, motion.velocity, motion.acceleration, FIRST_LINK)
    torque = columns @ inertial
    for k, model in enumerate(friction):
        torque[:, k] += model.torque(motion.velocity[:, k])
    return torque


def _relative(motion: ArmMotion, rebuilt: Array) -> tuple[float, float]:
    """RMS of the torque error over RMS of the torque, of each joint."""
    error = motion.torque - rebuilt
    first, second = (rms(error[:, k]) / rms(motion.torque[:, k]) for k in range(2))
    return first, second


def _table_rows(joint: int, made: Fit) -> list[Row]:
    why = (
        "three standard errors of the fit: alpha_0 to alpha_2 nearly cancel, because omega_s1 and "
        "omega_s2 are alike; and half a unit of the last digit"
    )
    truth = published(f"indri/table_1/joint_{joint}/indri_static")
    rows = []
    for side, sign in (("plus", ">"), ("minus", "<")):
        for k in range(5):
            (name,) = [p.name for p in truth.parameters if p.symbol == f"c{k}_{side}"]
            estimate = made.estimates[name]
            allowed = 3.0 * (estimate.stderr or 0.0) + 5e-4
            quantity = f"alpha_{k}, omega {sign} 0"
            where = f"table 1, joint {joint}"
            paper = truth.value(name)
            rows.append(Row(where, quantity, estimate.unit, paper, estimate.value, allowed, why))
    return rows


def _theta_rows(arm: ArmFit) -> list[Row]:
    why = "three standard errors of the least squares, and half a unit of the last digit"
    printed = ESTIMATED.split()
    rows = [
        Row("eq 14", p.name, p.unit, float(text), p.value, 3.0 * p.stderr + last_digit(text), why)
        for p, text in zip(arm.parameters, printed, strict=True)
    ]
    near = (
        "the estimate that made the data differs from the nominal value by as much; and three "
        "standard errors"
    )
    for p, text, nominal in zip(arm.parameters, printed, NOMINAL, strict=False):
        allowed = abs(float(text) - nominal) + 3.0 * p.stderr
        rows.append(Row("eq 15", f"{p.name}, nominal", p.unit, nominal, p.value, allowed, near))
    return rows


def _error_rows(
    where: str,
    what: str,
    printed: tuple[float, float],
    ours: tuple[float, float],
    allowed: tuple[float, str],
) -> list[Row]:
    """Relative errors of both joints; `allowed` is the share of the printed one, and why."""
    share, why = allowed
    rows = []
    for k, (paper, found) in enumerate(zip(printed, ours, strict=True), 1):
        quantity = f"relative error, {what}, joint {k}"
        rows.append(Row(where, quantity, "%", paper, 100.0 * found, share * paper, why))
    return rows

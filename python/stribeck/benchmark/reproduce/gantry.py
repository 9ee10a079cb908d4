"""The gantry's ball screw (Valdiero group): static friction map, and motion in both directions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.benchmark.reproduce.result import Picture, Reproduction, Row, last_digit
from stribeck.fitting.fit import fit
from stribeck.fitting.methods.segments import segment_points
from stribeck.fitting.methods.steady import SteadyPoints
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.published.sets import published
from stribeck.motion.simulate.drive import Pull, Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.run import simulate
from stribeck.recording.load import read
from stribeck.report.style import AFTER, BEFORE, MEASURED, legend_above, new_figure, strided, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

#: Table 1: moved mass [kg], inertia of the motor's shaft [kg m2], equivalent mass [kg].
MASS, SHAFT_INERTIA, EQUIVALENT = 11.250, 1.2298e-5, 23.0530
#: Efficiencies of motor and gear (section 3), whose product turns electrical into mechanical power.
MOTOR, GEAR = 0.74, 0.78
#: Speeds of the passes, m/s, each in both directions.
SPEEDS = (0.0005, 0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2)
#: Sensors: rate [Hz], RMS and step of the position [m], RMS of the power as a share of it.
RATE, POSITION_NOISE, POSITION_STEP, POWER_NOISE = 200.0, 10e-6, 5e-6, 0.01
#: RMS error of the wattmeter that stays over a pass, as a share: class 0.5.
METER = 0.005
#: Motor torque of the validation, N m.
VALIDATION_TORQUE = 13.0
#: Printed numbers by symbol.
PRINTED = {
    "Fc": ("Coulomb friction", "10300"),
    "Fs": ("static friction", "12300"),
    "vs": ("Stribeck velocity", "0.002"),
    "s2_plus": ("viscous coefficient, forward", "3.2189e3"),
    "s2_minus": ("viscous coefficient, backward", "1.5277e4"),
}


def reproduce(seed: int = 0, quick: bool = False) -> Reproduction:
    """Repeat table 1 and figures 2, 5 and 6."""
    truth = published("gantry/table_1/gantry_map")
    pitch = screw_pitch()
    joint = Joint.ball_screw(MASS, SHAFT_INERTIA, round(pitch, 5))
    speeds = [way * speed for speed in SPEEDS[:: 2 if quick else 1] for way in (1.0, -1.0)]
    log = pl.concat([_pass(truth, joint, v, k, seed) for k, v in enumerate(speeds)])
    recording = read(log, joint_kind="prismatic", standstill=True)
    points = segment_points(recording)
    made = fit("gantry_map", read(points.to_frame(), average="run", joint_kind="prismatic"))
    return Reproduction(
        paper="gantry",
        title="Modeling and experimental identification of friction nonlinearity in a ball screw "
        "mechanical transmission type in a gantry robot",
        source="Valdiero group",
        data=_DATA,
        left_out=("figures 1, 3 and 4: a sketch and block diagrams",),
        rows=(*_mass_rows(joint, pitch), *_map_rows(made)),
        pictures=(
            _map_picture(points, made),
            *(_validation(truth, made, joint, pitch, way, seed) for way in (-1, 1)),
        ),
    )


_DATA = (
    "The paper publishes no measurements. Passes at constant speed are simulated with the "
    f"printed map, at {len(SPEEDS)} speeds from {SPEEDS[0]} to {SPEEDS[-1]} m/s in both "
    "directions, pulled through a stiff drive.",
    f"Position: {RATE:g} Hz, {1e6 * POSITION_NOISE:g} um of noise, steps of "
    f"{1e6 * POSITION_STEP:g} um. Electrical power: {100 * POWER_NOISE:g} % of noise per sample "
    f"and {100 * METER:g} % per pass.",
    "The force is power times the efficiencies 0.74 of the motor and 0.78 of the gear, over "
    "speed, as in section 3.",
    "The screw's pitch is not printed: it follows from M_eq = M + J (2 pi/p)^2 of table 1. The "
    "viscous coefficients are printed in N s2/m2; eq 2 multiplies them by a speed, so they are in "
    "N s/m.",
    "The stiffness and damping of figure 4's bristles are not printed: the motions of figures 5 "
    "and 6 are simulated with the static map, whose stiction holds exactly.",
)


def screw_pitch() -> float:
    """The pitch with which table 1's masses fit, m."""
    return math.tau * math.sqrt(SHAFT_INERTIA / (EQUIVALENT - MASS))


def _pass(truth: Model, joint: Joint, speed: float, number: int, seed: int) -> pl.DataFrame:
    """One pass at a speed: position of the sensor, and force from the wattmeter."""
    rng = np.random.default_rng([seed, number])
    seconds = float(np.clip(0.4 / abs(speed), 1.0, 6.0))
    moved = simulate(truth, joint, Pull(1e9, speed, 2e7), seconds=seconds, step=1.0 / RATE)
    # A pull acts from outside: the drive's force is what friction and inertia need.
    force = moved.friction_torque + joint.inertia * moved.acceleration
    power = force * moved.velocity / (MOTOR * GEAR)
    meter = (1.0 + METER * rng.standard_normal()) * (
        1.0 + POWER_NOISE * rng.standard_normal(power.size)
    )
    position = moved.position + POSITION_NOISE * rng.standard_normal(power.size)
    return pl.DataFrame(
        {
            "run": np.full(power.size, number),
            "time": moved.time,
            "position": POSITION_STEP * np.round(position / POSITION_STEP),
            "torque": MOTOR * GEAR * power * meter / speed,
        }
    )


def _mass_rows(joint: Joint, pitch: float) -> list[Row]:
    size = MASS + SHAFT_INERTIA * (math.tau / pitch) ** 2
    slope = 2.0 * (size - MASS) / pitch
    rounded = "the pitch is rounded to 0.01 mm, which the mass follows; it is not printed"
    return [
        Row(
            "table 1",
            f"equivalent mass, pitch {1e3 * round(pitch, 5):.2f} mm",
            "kg",
            EQUIVALENT,
            joint.inertia,
            slope * 5e-6 + last_digit("23.0530"),
            rounded,
        )
    ]


def _map_rows(made: Fit) -> list[Row]:
    why = (
        "three standard errors of the fit, which the class of the wattmeter sets, and half a unit "
        "of the last printed digit"
    )
    names = {p.symbol: p.name for p in made.model.parameters}
    rows = []
    for symbol, (quantity, text) in PRINTED.items():
        estimate = made.estimates[names[symbol]]
        allowed = 3.0 * (estimate.stderr or 0.0) + last_digit(text)
        rows.append(
            Row("table 1", quantity, estimate.unit, float(text), estimate.value, allowed, why)
        )
    return rows


def _map_picture(points: SteadyPoints, made: Fit) -> Picture:
    """Figure 2: the static map."""
    figure = new_figure(9.0, 3.6)
    whole, slow = figure.subplots(1, 2, sharey=True)
    for axes, span in ((whole, 0.21), (slow, 0.011)):
        style(axes)
        v = np.concatenate([np.linspace(-span, -1e-6, 300), np.linspace(1e-6, span, 300)])
        torque = np.insert(made.model.torque(v), 300, np.nan)
        axes.plot(np.insert(v, 300, 0.0), torque / 1e3, color=AFTER, label="gantry_map, identified")
        inside = np.abs(points.velocity) <= span
        force = points.friction_torque[inside] / 1e3
        axes.plot(points.velocity[inside], force, "o", color=MEASURED, markersize=4, label="passes")
        axes.set_xlabel("velocity [m/s]")
    whole.set_ylabel("friction force [kN]")
    slow.set_title("low speed", loc="left", fontsize=10.5)
    legend_above(whole, 2)
    return Picture(
        "figure_2",
        "figure 2",
        "Static friction map from passes at constant speed: 12.3 kN at rest, 10.3 kN beyond the "
        "Stribeck velocity, and a steeper rise backward than forward, as in table 1.",
        figure,
    )


def _validation(
    truth: Model, made: Fit, joint: Joint, pitch: float, way: int, seed: int
) -> Picture:
    """Figures 5 and 6: displacement under a step of the motor torque, measured and simulated."""
    number, name = (6, "forward") if way > 0 else (5, "backward")
    force = way * VALIDATION_TORQUE * math.tau / pitch
    drive = np.where(np.arange(1200) < 100, 0.0, force)
    measured, modelled = (
        simulate(model, joint, Torque(drive), step=1e-3) for model in (truth, made.model)
    )
    rng = np.random.default_rng([seed, 100 + number])
    seen = measured.position + POSITION_NOISE * rng.standard_normal(drive.size)
    figure = new_figure(6.5, 4.2)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    rows = strided(drive.size)
    _line(top, measured.time[rows], 1e3 * seen[rows], MEASURED, "simulated measurement")
    _line(top, measured.time[rows], 1e3 * modelled.position[rows], AFTER, "identified map")
    _line(bottom, measured.time[rows], 1e3 * (seen - modelled.position)[rows], BEFORE, "")
    top.set_ylabel("displacement [mm]")
    bottom.set(xlabel="time [s]", ylabel="difference [mm]")
    legend_above(top, 2)
    largest = 1e3 * float(np.abs(seen - modelled.position).max())
    return Picture(
        f"figure_{number}",
        f"figure {number}",
        f"Displacement {name} under {VALIDATION_TORQUE:g} N m of motor torque, with the map that "
        f"made the data and with the identified one; largest difference {largest:.2g} mm.",
        figure,
    )


def _line(axes: Axes, x: Array, y: Array, colour: str, label: str) -> None:
    style(axes)
    axes.plot(x, y, color=colour, linewidth=1.2, label=label)

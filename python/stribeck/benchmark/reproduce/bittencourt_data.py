"""What stands in for the measurements of Bittencourt et al. 2010: its printed models and noise.

Torques are divided by the largest manipulation torque, speeds are those of the motor in rad/s, as
in the paper.
"""

from __future__ import annotations

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.models.model import Model

Array = NDArray[np.float64]

#: Twelve speeds in both directions (section II-A), spread as the crosses of figure 3, rad/s.
SPEEDS = np.array([1.5, 4.0, 8.7, 15.0, 25.0, 40.0, 62.0, 90.0, 125.0, 170.0, 220.0, 280.0])
#: "The sum of absolute prediction errors in this case is no more than 0.03", over twelve speeds.
ERROR_SUM = 0.03
#: RMS noise of a point, whose mean absolute value is then 0.03/12.
POINT_NOISE = ERROR_SUM / SPEEDS.size / np.sqrt(2.0 / np.pi)
#: Seconds of the excitation of figure 2, and its sampling rate; 220 Hz is enough (section II-A).
SECONDS, RATE = 135.0, 250.0
#: Longest time [s] and travel [rad, of the motor] of a pass: the slow ones fill the 135 seconds.
HOLD, TRAVEL = 9.3, 180.0
#: Section II-B: thermal decay constant, and the error of an oil temperature (a usual Pt100), K.
KAPPA_HOURS, TEMPERATURE_NOISE = 3.04, 0.2


def excitation(model: Model, seed: int) -> pl.DataFrame:
    """Figure 2: speed levels in both directions, and the torque over gravity that drives them.

    The error that averaging cannot remove is one draw for each pass.
    """
    rng = np.random.default_rng([seed, 1])
    ramp, rest = int(0.25 * RATE), np.zeros(int(0.3 * RATE))

    def level(speed: float) -> Array:
        hold = int(min(HOLD, TRAVEL / abs(speed)) * RATE)
        up, down = np.linspace(0, 1, ramp), np.linspace(1, 0, ramp)
        return speed * np.concatenate([up, np.ones(hold), down, rest])

    levels = np.ravel(np.column_stack([SPEEDS, -SPEEDS]))
    spread = np.sqrt(2.0) * POINT_NOISE  # A point is the mean of two passes.
    passes = [level(speed) for speed in levels]
    velocity = np.concatenate([rest, *passes])
    drawn = spread * rng.standard_normal(levels.size)
    error = np.repeat(np.append(0.0, drawn), [rest.size, *(one.size for one in passes)])
    position = np.cumsum(velocity) / RATE
    # Gravity over the arm's angle: a share of the largest torque, by a gear of about 200.
    gravity = -0.39 * np.cos(position / 200.0)
    inertia = 2e-4 * np.gradient(velocity) * RATE
    noise = 0.004 * rng.standard_normal(velocity.size)
    return pl.DataFrame(
        {
            "time": np.arange(velocity.size) / RATE,
            "position": position,
            "velocity": velocity,
            "torque": model.torque(velocity) + gravity + inertia + error + noise,
        }
    )


def points(model: Model, temperature: Array, load: Array, seed: int) -> pl.DataFrame:
    """Static friction curves of twelve points, one for each pair of temperature and load [n]."""
    rng = np.random.default_rng([seed, 2])
    velocity = np.tile(SPEEDS, temperature.size)
    warm, loaded = (np.repeat(x, SPEEDS.size) for x in (temperature, load))
    friction = model.torque(velocity, temperature=warm, load_torque=loaded)
    return pl.DataFrame(
        {
            "run": np.arange(velocity.size),
            "velocity": velocity,
            "temperature": warm,
            "load_torque": loaded,
            "friction_torque": friction + POINT_NOISE * rng.standard_normal(velocity.size),
        }
    )


def loads_of_figure_6() -> tuple[Array, Array]:
    """Fifty curves over the manipulation torque at 34 degC."""
    load = np.linspace(-0.73, 0.44, 50)
    return np.full(load.size, 34.0), load


def temperatures_of_figure_7() -> tuple[Array, Array]:
    """Fifty curves from 81.2 to 38 degC while the joint cools, in turn at two loads."""
    temperature = np.linspace(81.2, 38.0, 50)
    return temperature, np.where(np.arange(50) % 2, -0.72, -0.02)


def conditions_of_figure_9(seed: int) -> tuple[Array, Array]:
    """250 experiments: temperatures between 20 and 40 degC, loads between -0.8 and 0.8."""
    rng = np.random.default_rng([seed, 3])
    step = np.arange(250)
    temperature = 30.0 - 10.0 * np.cos(2.0 * np.pi * step / 125.0)
    load = np.repeat(rng.uniform(-0.8, 0.8, 25), 10)
    return temperature, load


def warming(seed: int) -> tuple[Array, Array]:
    """Hours and oil temperatures [degC] of curves measured one after another for ten hours."""
    rng = np.random.default_rng([seed, 4])
    hours = np.arange(0.0, 10.0, SECONDS / 3600.0)
    settled = 40.0 - 18.0 * np.exp(-hours / KAPPA_HOURS)
    return hours, settled + TEMPERATURE_NOISE * rng.standard_normal(hours.size)

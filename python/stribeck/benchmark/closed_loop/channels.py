"""The channels recorded by the drive, all with the same causal filters and so the same delay.

Two first-order low-pass filters in a row, at the controller's rate. Position comes from the
encoder, and velocity is its filtered difference. The current passes the same filters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.benchmark.closed_loop.machine import STEP, Machine
from stribeck.benchmark.closed_loop.simulation import Course

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Channels:
    """Channels of the drive, every `STEP`.

    Attributes
    ----------
    exact
        The velocity without the noise of the communication with the drive.
    direction, carried
        Filtered state of the contact and torque of the transmission (`Course`).
    velocity_noise
        RMS error of the velocity: encoder quantisation, and the added noise.
    """

    seen: Array
    position: Array
    velocity: Array
    exact: Array
    acceleration: Array
    torque: Array
    direction: Array
    carried: Array
    velocity_noise: float


def low_pass(values: Array, machine: Machine) -> Array:
    """Apply both filters, starting from rest."""
    share = 1 - math.exp(-machine.cutoff * STEP)
    once = values - values[0]
    for _ in range(2):
        once = np.asarray(scipy.signal.lfilter([share], [1.0, share - 1.0], once))
    return once + values[0]


def channels(machine: Machine, course: Course, noise: Array) -> Channels:
    """Return the channels of a course, with unit `noise` of the speed."""

    def last(values: Array) -> Array:
        """Value during the step that ends at a row, as for the difference of positions."""
        return np.concatenate([values[:1], values[:-1]])

    def speed(q: Array) -> Array:
        return low_pass(np.diff(q, prepend=q[0]) / STEP, machine)

    velocity = speed(course.seen)
    steps = float(np.std(velocity - speed(course.position)))
    return Channels(
        seen=course.seen,
        position=low_pass(course.seen, machine),
        velocity=velocity + machine.speed_noise * noise,
        exact=velocity,
        acceleration=np.diff(velocity, prepend=velocity[0]) / STEP,
        torque=low_pass(last(course.shown), machine),
        direction=low_pass(last(course.direction), machine),
        carried=low_pass(last(course.carried), machine),
        velocity_noise=math.hypot(machine.speed_noise, steps),
    )

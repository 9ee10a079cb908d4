"""The joint under PD control, step by step.

Dry friction is set-valued: each step computes the impulse that brings the joint to rest, and the
joint sticks if dry friction can supply it (Moreau's time stepping). Motor and link are one body, or
two connected by a torsional spring or backlash and integrated with smaller steps.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.closed_loop.actuator import Actuator
from stribeck.benchmark.closed_loop.contact import Iwan
from stribeck.benchmark.closed_loop.friction import (
    Amplitudes,
    Friction,
    speeding_up,
    stribeck_height,
)
from stribeck.benchmark.closed_loop.machine import STEP, Machine
from stribeck.benchmark.closed_loop.reference import Reference
from stribeck.benchmark.closed_loop.transmission import Transmission

Array = NDArray[np.float64]
#: Coefficient per step of the low-pass filters of load torque and acceleration in the friction.
FOLLOWS = 0.3


@dataclass(frozen=True)
class Course:
    """The simulated motion, at intervals of `STEP`.

    Attributes
    ----------
    shown : array [n]
        Torque computed from the current.
    seen : array [n]
        Position measured by the encoder.
    direction : array [n]
        Factor of the dry friction, in -1..1.
    falls : array [n]
        Value of the Stribeck curve.
    carried : array [n]
        Torque in the transmission minus that of a rigid one; zero for a single body.
    """

    position: Array
    velocity: Array
    shown: Array
    seen: Array
    direction: Array
    falls: Array
    carried: Array


def simulate(
    machine: Machine,
    friction: Friction,
    actuator: Actuator,
    transmission: Transmission | None,
    reference: Reference,
    payload: Array,
    temperature: Array,
    x: Amplitudes,
) -> Course:
    """Simulate the joint along its reference."""
    joint = _Joint(machine, friction, payload, temperature, reference.time, x)
    drive = _Drive(machine, actuator, reference, payload)
    n = reference.time.size
    rows = [[0.0] * n for _ in range(7)]
    for i in range(n):
        shown = drive.command(i, joint.position)
        rows[0][i], rows[1][i] = joint.position, joint.velocity
        rows[2][i], rows[3][i] = shown, drive.seen
        acting = actuator.acting(shown)
        if transmission is None:
            joint.step(i, acting, STEP, machine.inertia, joint.load_at(i))
        else:
            rows[6][i] = transmission.step(i, joint, acting)
        rows[4][i], rows[5][i] = joint.direction, joint.fallen
    course = Course(*(np.asarray(row) for row in rows))
    if transmission is None:
        return course
    rigid = _rigid_torque(machine, course.position, payload)
    return replace(course, carried=course.carried - rigid)


def _rigid_torque(machine: Machine, position: Array, payload: Array) -> Array:
    """Torque at the link of a rigid transmission."""
    ends = np.pad(position, 1, mode="edge")
    acceleration = (ends[2:] - 2 * position + ends[:-2]) / STEP**2
    link = (1 - machine.motor_share) * machine.inertia
    return np.asarray(link * acceleration + machine.gravity_torque(position, payload))


class _Drive:
    """Sampled PD control with feedforward of inertia and gravity."""

    def __init__(
        self, machine: Machine, actuator: Actuator, reference: Reference, payload: Array
    ) -> None:
        self._count, self._kp, self._kd = machine.count, machine.stiffness, machine.damping
        self._share = 1 - math.exp(-machine.cutoff * STEP)
        self._target, self._speed = reference.position.tolist(), reference.velocity.tolist()
        ahead = machine.inertia * reference.acceleration
        self._ahead = (ahead + machine.gravity_torque(reference.position, payload)).tolist()
        self._most = 3 * actuator.largest
        self.seen = reference.position[0]
        self._once = self._twice = 0.0

    def command(self, i: int, position: float) -> float:
        """Torque commanded by the controller."""
        seen = round(position / self._count) * self._count
        self._once += self._share * ((seen - self.seen) / STEP - self._once)
        self._twice += self._share * (self._once - self._twice)
        self.seen = seen
        wanted: float = (
            self._ahead[i]
            + self._kp * (self._target[i] - seen)
            + self._kd * (self._speed[i] - self._twice)
        )
        return max(-self._most, min(self._most, wanted))


class _Joint:
    """Motor side of the joint with its friction, from tables of the same formulas."""

    def __init__(
        self,
        machine: Machine,
        friction: Friction,
        payload: Array,
        temperature: Array,
        time: Array,
        x: Amplitudes,
    ) -> None:
        shapes, self._x = friction.shapes, x
        fastest = 3 * machine.vmax
        low, high = machine.centre - 1.6 * machine.half, machine.centre + 1.6 * machine.half
        self._coulomb = machine.coulomb
        self._height = stribeck_height(x)
        self._falls = table(shapes.falls, 0.0, fastest, 8001)
        self._rate = table(lambda s: machine.viscous * friction.bent(s, x), 0.0, fastest, 2001)
        y = x.get("position", 0.0)
        self._place = table(lambda q: np.maximum(1 + y * shapes.of_place(q), 0.05), low, high)
        self._constant = table(lambda q: friction.conservative(q, x), low, high)
        self._gravity = table(lambda q: machine.gravity_torque(q, np.ones_like(q)), low, high)
        self._error = table(lambda q: gravity_error(machine, q, x), low, high)
        heaviest = 6 * (machine.gravity * 1.6 + machine.inertia * machine.vmax / machine.ramp)
        self._per_load = table(shapes.per_load, 0.0, heaviest, 4001)
        self._fades = table(friction.fades, 0.0, fastest, 2001)
        self._outside_place = table(shapes.outside_of_place, low, high)
        self._outside_speed = table(shapes.outside_of_speed, 0.0, fastest, 4001)
        self._gap, self._uneven = shapes.gap, shapes.uneven
        self._of_dry, self._of_rate = (x.get("direction", 0.0) * d for d in shapes.directions)
        self._change: list[float] = friction.change(time, temperature, x).tolist()
        self._thinned: list[float] = friction.thinned(temperature, x).tolist()
        self._payload: list[float] = payload.tolist()
        self._late = round(x.get("frictional_lag", 0.0) / STEP)
        self._speeds: list[float] = []
        self._iwan = Iwan(x["presliding"] * machine.half) if "presliding" in x else None
        most = 4 * machine.vmax**2 / machine.ramp
        self._speeding_up = table(lambda p: speeding_up(machine, p), -most, most, 4001)
        self._load = self._smooth = 0.0
        self.position, self.velocity, self.acceleration = machine.centre, 0.0, 0.0
        self.direction, self.fallen = 0.0, float(shapes.falls(np.zeros(1))[0])

    def load_at(self, i: int, position: float | None = None) -> float:
        """Torque of gravity at the given position; default: that of the joint."""
        q = self.position if position is None else position
        return self._payload[i] * self._gravity(q) + self._error(q)

    def step(self, i: int, acting: float, step: float, inertia: float, against: float) -> None:
        """Integrate one `step` with the torque `acting` of the motor and `against` of the load."""
        speed = abs(self.velocity)
        if self._late:
            self._speeds.append(speed)
            speed = self._speeds[max(len(self._speeds) - 1 - self._late, 0)]
        self.fallen = self._falls(speed)
        speed = abs(self.velocity)
        rate = math.copysign(self._rate(speed), self.velocity) * self._thinned[i]
        rate *= 1 + self._of_rate * (1 if self.velocity > 0 else -1)
        free = acting - against - self._constant(self.position) - rate
        reached = self.velocity + step / inertia * free
        dry = self._dry(i, speed, inertia * self.acceleration + against, reached)
        if self._iwan is not None:
            new = reached - step / inertia * dry * self.direction
            self.direction = self._iwan.move(step * new)
        else:
            most = step / inertia * dry
            taken = most if reached > most else -most if reached < -most else reached
            new, self.direction = reached - taken, taken / most
        self.acceleration = (new - self.velocity) / step
        self._smooth += FOLLOWS * (self.acceleration - self._smooth)
        self.velocity = new
        self.position += step * new

    def _dry(self, i: int, speed: float, load: float, towards: float) -> float:
        """Magnitude of dry friction for motion `towards`."""
        x = self._x
        made = (1 + self._height * self.fallen) * self._change[i] * self._place(self.position)
        if "position_speed" in x:
            shape = self._outside_place(self.position) * self._outside_speed(speed)
            made *= max(1 + x["position_speed"] * shape, 0.05)
        elif "speed_gap" in x:
            made *= 1 + x["speed_gap"] * (self._gap[0] < speed < self._gap[1])
        elif "acceleration_sign" in x:
            made *= 1 + x["acceleration_sign"] * self._speeding_up(self.velocity * self._smooth)
        if "load" in x or "quadrant" in x:
            self._load += FOLLOWS * (load - self._load)
            teeth = self._per_load(abs(self._load))
            made += x.get("load", 0.0) * teeth
            if "quadrant" in x:
                power = math.copysign(1.0, towards * self._load)
                made += x["quadrant"] * teeth * (1 + self._uneven * power * self._fades(speed))
        return self._coulomb * made * (1 + self._of_dry * (1 if towards > 0 else -1))


def gravity_error(machine: Machine, q: Array, x: Amplitudes) -> Array:
    """Torque of gravity missing in the robot's model, because of a wrong centre of mass."""
    return np.asarray(x.get("gravity", 0.0) * machine.gravity * np.sin(q + machine.phase + 0.9))


def table(
    f: Callable[[Array], Array], low: float, high: float, n: int = 6001
) -> Callable[[float], float]:
    """Return a fast scalar version of `f` on [low, high], constant outside."""
    values: list[float] = np.broadcast_to(f(np.linspace(low, high, n)), (n,)).tolist()
    scale, last = (n - 1) / (high - low), n - 1

    def at(at_x: float) -> float:
        r = (at_x - low) * scale
        if r <= 0:
            return values[0]
        i = int(r)
        if i >= last:
            return values[last]
        return values[i] + (values[i + 1] - values[i]) * (r - i)

    return at

"""Identification, compensation and direct teaching of Tadese et al. 2021, by the public methods."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from stribeck.benchmark.reproduce import tadese_data as data
from stribeck.fitting.fit import fit
from stribeck.fitting.methods.three_step import ThreeStepFit, three_step_fit
from stribeck.fitting.result import Fit
from stribeck.motion.compensate.factor import Factor, largest_factor
from stribeck.motion.compensate.loop import Compensator
from stribeck.motion.compensate.teaching import Guidance, Teaching, teach
from stribeck.motion.compensate.tracking import Tracking, compensate
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Quintic, Trapezoid
from stribeck.recording.load import read
from stribeck.recording.recording import Recording

#: From -90 to 90 degrees; top speed of the desired trajectory [rad/s], and the hand's 34 deg/s.
START, END, SPEED, HAND_SPEED = -math.pi / 2, math.pi / 2, 1.2, math.radians(34.0)
#: The arm alone at joint 2, without the payload: inertia [kg m2] and gravity [N m].
ARM_INERTIA, ARM_GRAVITY = 1.5, 16.0
STARTS = 3


@dataclass(frozen=True)
class Identified:
    """One joint, identified.

    Attributes
    ----------
    axis
        The joint with its true friction.
    no_load, loaded, presliding
        The recordings of the three steps.
    full, lugre
        The comprehensive model; LuGre on the points of the first two steps.
    """

    axis: data.Axis
    no_load: Recording
    loaded: Recording
    presliding: Recording
    full: ThreeStepFit
    lugre: Fit


def points(frame: pl.DataFrame) -> Recording:
    """Steady-state points as a recording."""
    return read(frame, average="run", joint_kind="revolute")


def slow(axis: data.Axis, seed: int) -> Recording:
    """A presliding recording."""
    return read(data.presliding(axis, seed), joint_kind="revolute", standstill=True)


def identified(number: int, seed: int) -> Identified:
    """Identify a joint in three steps, and LuGre beside it."""
    axis = data.axis(number)
    warm = data.points(axis, data.TEMPERATURES, np.zeros(data.TEMPERATURES.size), seed + 1)
    heavy = data.points(axis, np.full(data.LOADS.size, 35.0), axis.loads, seed + 2)
    no_load, loaded, presliding = points(warm), points(heavy), slow(axis, seed + 3)
    full = three_step_fit("tadese_full", no_load, loaded, presliding, starts=STARTS)
    # "Both models are parameterized to fit the same identification data" (section V-A 2).
    same = points(pl.concat([warm, heavy]).with_columns(run=pl.int_range(pl.len())))
    return Identified(axis, no_load, loaded, presliding, full, lugre_fit(same, full))


def lugre_fit(recording: Recording, full: Fit) -> Fit:
    """LuGre on steady points, with the bristle's stiffness of the presliding experiment.

    Table 2's damping holds below 0.001 rad/s. LuGre would keep it at all speeds: as feedback it
    exceeds the inertia's resistance, and joints 4 to 6 oscillate. It is left out.
    """
    bristle = {"bristle_stiffness": full.model.value("bristle_stiffness"), "bristle_damping": 0.0}
    return fit("lugre", recording, fix=bristle, starts=STARTS)


def bristles(made: Identified, seeds: Sequence[int]) -> np.ndarray:
    """Stiffness and damping from all three steps, and again with other noise, array [k, 2]."""
    fits = [made.full, *(identified(made.axis.number, seed).full for seed in seeds)]
    names = ("bristle_stiffness", "bristle_damping")
    return np.array([[one.model.value(name) for name in names] for one in fits])


def tracked(made: Identified) -> Tracking:
    """Section V-B 1: hot and loaded, without compensation, with LuGre, with the full model."""
    k = made.axis.number - 1
    joint = Joint.revolute(data.INERTIAS[k], gravity_sin=data.GRAVITIES[k])
    return compensate(
        made.axis.friction,
        joint,
        Quintic(START, END, 1.875 * (END - START) / SPEED),
        [Compensator(made.lugre.model, name="LuGre"), Compensator(made.full.model, name="full")],
        temperature=data.WARM[k],
        encoder=data.ENCODER,
    )


def factors(made: Identified) -> tuple[Factor, Factor]:
    """The largest factors of LuGre and of the full model that never overcompensate."""
    box = {"velocity": (-1.8, 1.8), "temperature": (20.0, 60.0), "load_torque": (-60.0, 60.0)}
    return largest_factor(made.lugre, made.full, box), largest_factor(made.full, made.full, box)


def taught(made: Identified) -> Teaching:
    """Section V-B 2: the hand moves joint 2 at 27 degC, with factors 0.35 and 0.85."""
    joint = Joint.revolute(ARM_INERTIA, gravity_sin=ARM_GRAVITY)
    path = Trapezoid(START, END, HAND_SPEED, 2.0)
    return teach(
        made.axis.friction,
        joint,
        Guidance.with_bandwidth(path, joint.inertia),
        [
            Compensator(made.lugre.model, 0.35, name="LuGre, factor 0.35"),
            Compensator(made.full.model, 0.85, name="full model, factor 0.85"),
        ],
        temperature=data.ROOM,
        encoder=data.ENCODER,
    )

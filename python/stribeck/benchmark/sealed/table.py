"""Sealed nuisances by name."""

from __future__ import annotations

from collections.abc import Mapping

from stribeck.benchmark.nuisances.bench import Nuisance
from stribeck.benchmark.sealed.cable_hysteresis import cable_hysteresis
from stribeck.benchmark.sealed.clock_drift import clock_drift
from stribeck.benchmark.sealed.encoder_eccentricity import encoder_eccentricity
from stribeck.benchmark.sealed.joint_coupling import joint_coupling
from stribeck.benchmark.sealed.phase_gain import phase_gain
from stribeck.benchmark.sealed.sensor_creep import sensor_creep
from stribeck.benchmark.sealed.stale_rows import stale_rows
from stribeck.benchmark.sealed.supply_sag import supply_sag
from stribeck.benchmark.sealed.torque_dead_zone import torque_dead_zone

#: In the order in which they act.
SEALED: Mapping[str, Nuisance] = {
    "cable_hysteresis": cable_hysteresis,
    "joint_coupling": joint_coupling,
    "supply_sag": supply_sag,
    "torque_dead_zone": torque_dead_zone,
    "sensor_creep": sensor_creep,
    "phase_gain": phase_gain,
    "encoder_eccentricity": encoder_eccentricity,
    "clock_drift": clock_drift,
    "stale_rows": stale_rows,
}

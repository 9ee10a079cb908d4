"""Nuisances by name."""

from __future__ import annotations

from collections.abc import Mapping

from stribeck.benchmark.nuisances.amplifier_warm_up import amplifier_warm_up
from stribeck.benchmark.nuisances.bench import Nuisance
from stribeck.benchmark.nuisances.current_filter import current_filter
from stribeck.benchmark.nuisances.lagging_thermometer import lagging_thermometer
from stribeck.benchmark.nuisances.load_scale import load_scale
from stribeck.benchmark.nuisances.sensor_lag import sensor_lag
from stribeck.benchmark.nuisances.structural_mode import structural_mode
from stribeck.benchmark.nuisances.time_jitter import time_jitter
from stribeck.benchmark.nuisances.velocity_filter import velocity_filter

#: In the order in which they act: torques first, then sensors, then the bus.
NUISANCES: Mapping[str, Nuisance] = {
    "structural_mode": structural_mode,
    "load_scale": load_scale,
    "amplifier_warm_up": amplifier_warm_up,
    "current_filter": current_filter,
    "sensor_lag": sensor_lag,
    "velocity_filter": velocity_filter,
    "lagging_thermometer": lagging_thermometer,
    "time_jitter": time_jitter,
}

"""What the effects of temperature on dry and on viscous friction have in common."""

from __future__ import annotations

import numpy as np
import polars as pl

from stribeck.effect.base import Array, GeneratedRecording, Identified, Obstacle
from stribeck.effect.columns import hats
from stribeck.effect.facts import RecordingFacts, spread
from stribeck.recording.recording import Recording

#: Temperature range (1st to 99th percentile) in K below which no thermal effect is tested.
TEMPERATURE_SPAN = 5.0
#: Temperature range in K below which a thermometer reads no change.
SMALL_SPAN = 1.0
#: Rank correlation of temperature and time from which they are indistinguishable.
CORRELATED = 0.9
#: Assumed rise of temperature between the two runs of a planned motion, K.
WARMING = 10.0

DESIGN_NOTE = (
    f"a motion does not set the temperature: run it cold, and again when the joint is at least "
    f"{WARMING:.0f} K warmer, and record the temperature; the figures are for both runs together"
)


def temperature_hardly_varies(facts: RecordingFacts) -> Obstacle | None:
    """The temperature was not recorded, or its range is too narrow."""
    temperature = facts.scored(facts.recording.temperature)
    if temperature is None:
        return Obstacle("no temperature was recorded", "record the joint's temperature")
    span = spread(temperature)
    if span >= TEMPERATURE_SPAN:
        return None
    return Obstacle(
        f"the temperature varies by only {span:.1f} K",
        f"record from cold to warm, at least {TEMPERATURE_SPAN:.0f} K, and cool down again",
    )


def one_way(recording: Recording) -> str | None:
    """How the temperature follows the time, so that neither can be told from the other.

    Either "warms up" or "cools down"; None where it does not.

    Examples
    --------
    >>> t = np.linspace(0.0, 60.0, 6001)
    >>> def joint(temperature):
    ...     motion = {"position": np.sin(t), "torque": np.cos(t)}
    ...     return Recording.from_columns(time=t, temperature=temperature, **motion)
    >>> one_way(joint(20.0 + 10.0 * (1.0 - np.exp(-t / 30.0))))
    'warms up'
    >>> one_way(joint(20.0 + 10.0 * np.sin(np.pi * t / 60.0)))
    """
    r = recording
    if r.temperature is None or spread(r.temperature[r.moving]) < SMALL_SPAN:
        return None
    both = pl.DataFrame({"time": r.elapsed[r.moving], "temperature": r.temperature[r.moving]})
    correlation = both.select(pl.corr("time", "temperature", method="spearman")).item()
    if abs(correlation) <= CORRELATED:
        return None
    return "warms up" if correlation > 0 else "cools down"


def reference_temperature(recording: Recording) -> dict[str, float]:
    """The mean temperature of the scored samples, as a constant."""
    if recording.temperature is None:
        return {}
    return {"reference_temperature": float(np.mean(recording.temperature[recording.moving]))}


def generated_temperature(made: GeneratedRecording) -> dict[str, float]:
    """The same in a generated recording."""
    return {"reference_temperature": made.middle_temperature}


def functions_of_temperature(fit: Identified) -> list[Array]:
    """Any function of the temperature, arrays [m]."""
    temperature = fit.recording.temperature
    return [] if temperature is None else hats(temperature[fit.rows], 6)


def cold_and_hot(after: Identified, part: str) -> tuple[float, float, float, float]:
    """Coldest and warmest temperature, and a part of the friction at each, at `half_speed`."""
    m = after.model
    cold, hot = m.box["temperature"]
    split = m.split(half_speed(after), temperature=np.array([cold, hot]))
    return cold, hot, float(split[part][0]), float(split[part][1])


def half_speed(after: Identified) -> float:
    """Half of the largest speed in the operating box."""
    return 0.5 * max(abs(x) for x in after.model.box["velocity"])

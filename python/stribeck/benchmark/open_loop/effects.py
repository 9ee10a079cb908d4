"""Effects that can be hidden in a recording, motions that cannot show them, and amplitudes."""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.benchmark.open_loop.outside import OUTSIDE

EFFECTS = (
    "stribeck",
    "nonlinear_viscous",
    "direction",
    "load",
    "temperature_viscous",
    "temperature_dry",
    "presliding",
    "position",
    "offset",
    "inertia",
    "gravity",
    "delay",
    "gain",
    "spring",
    "ripple",
    "drift",
    "saturation",
    "quadrant",
)

#: Effects that each limited motion cannot show, from the column "needs" of the table of effects.
LIMITS: dict[str, list[str]] = {
    "isothermal": ["temperature_viscous", "temperature_dry"],
    "one_direction": ["direction", "offset", "position", "ripple", "spring"],
    "constant_load": ["load", "quadrant", "gain", "saturation"],
    "no_slow_motion": [
        "stribeck",
        "nonlinear_viscous",
        "presliding",
        "frictional_lag",
        "inertia",
    ],
    "warm_up_only": ["drift"],
    "short_range": ["gravity"],
}

#: Simpler effects that an effect contains; naming them too is not an error.
IMPLIED = {"quadrant": ["load"]}

#: Largest amplitude tried; if it does not reach the wanted size, the noise is lowered.
CAPS = {
    "stribeck": 1.2,
    "nonlinear_viscous": 4.0,
    "direction": 0.7,
    "load": 2.0,
    "temperature_viscous": 1.0,
    "temperature_dry": 0.6,
    "presliding": 0.05,
    "position": 1.2,
    "offset": 1.0,
    "inertia": 0.7,
    "gravity": 0.5,
    "delay": 2.6,
    "gain": 0.35,
    "spring": 2.0,
    "ripple": 1.5,
    "drift": 0.7,
    "saturation": 0.75,
    "quadrant": 1.0,
    **dict.fromkeys(OUTSIDE, 0.6),
    "restart": 0.3,
}

#: Smallest presliding distance (in half strokes) that the encoder resolves; otherwise the noise is
#: raised.
SHORTEST_REACH = 1.2e-3


def check(
    effects: Sequence[str], size: float | Sequence[float], limits: dict[str, bool]
) -> tuple[list[str], list[float], str | None]:
    """Return the names of the effects, a size for each, and the limit, if any."""
    names = [e for e in effects if e != "none"]
    known = (*EFFECTS, *OUTSIDE)
    unknown = [e for e in names if e not in known] + [k for k in limits if k not in LIMITS]
    if unknown:
        raise ValueError(f"unknown effect or limit: {unknown}")
    on = [k for k, wanted in limits.items() if wanted]
    if len(on) > 1:
        raise ValueError(f"one limit at a time, not {on}")
    sizes = [float(size)] * len(names) if isinstance(size, int | float) else list(size)
    if len(sizes) != len(names):
        raise ValueError("one size for each effect")
    return names, sizes, on[0] if on else None

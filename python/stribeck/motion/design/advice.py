"""What a motion cannot do for an effect, in one sentence each."""

from __future__ import annotations

#: How much warmer the second of two runs is reckoned with, K.
WARMING = 10.0
#: Effects that no motion at one temperature shows.
OF_TEMPERATURE = ("temperature_dry", "temperature_viscous")

_WARM = (
    f"a motion does not set the temperature: run it cold, and again when the joint is at least "
    f"{WARMING:.0f} K warmer, and record the temperature; the figures are for both runs together"
)
_PAYLOAD = (
    "inertia and gravity alone vary the load here: run the motion again with another payload, "
    "whose mass is known, to show smaller effects and to tell them from what the position does"
)

ADVICE = {
    "temperature_dry": _WARM,
    "temperature_viscous": _WARM,
    "load": _PAYLOAD,
    "quadrant": _PAYLOAD,
    "gain": _PAYLOAD,
    "saturation": (
        "a motion within these limits may not reach the largest torque of the motor: run it again "
        "with the heaviest payload"
    ),
    "drift": (
        "wear and run-in take hours: run the motion again and again over a shift, and record the "
        "temperature; the figures are for a change within one run"
    ),
    "presliding": (
        "what happens before sliding lasts micrometres to millimetres: record at the highest rate "
        "and at the finest resolution of the encoder"
    ),
    "elasticity": (
        "a motion at one end of the drive train shows its twist only where the load torque changes "
        "fast: record the positions at motor and joint as well"
    ),
    "backlash": (
        "teeth change flanks only where the load torque changes its sign: choose a payload or an "
        "orientation that balances the joint within its range"
    ),
    "delay": "no motion tells which channel is late: compare with a common trigger or clock",
}

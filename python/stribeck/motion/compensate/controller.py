"""The model-based H-infinity PID of Tadese et al. 2021, eqs 23 to 25."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stribeck.base.errors import SpecError
from stribeck.motion.simulate.drive import Controller

#: Frequency of the three poles of the error with the default gains, Hz.
BANDWIDTH = 5.0


@dataclass(frozen=True)
class HInfinity:
    """Gains of the H-infinity PID.

    ``tau_m = M qr'' + C qr' + g + (K + 1/gamma^2) s`` with the error ``e = qd - q``, the reference
    ``qr' = qd' + Kp e + KI int e`` and ``s = qr' - q' = e' + Kp e + KI int e``. (The paper prints
    ``q'`` instead of ``qd'`` and a minus before the last term, which is unstable.)

    Attributes
    ----------
    proportional, integral
        ``Kp`` in 1/s and ``KI`` in 1/s2, with ``Kp^2 > 2 KI``.
    gain
        ``K``, N m s/rad or N s/m.
    attenuation
        ``gamma``: smaller values attenuate disturbances more; infinite adds nothing to ``K``.

    Examples
    --------
    >>> gains = HInfinity.with_bandwidth(0.5, hertz=1.0)
    >>> gains.proportional**2 > 2.0 * gains.integral
    True
    """

    proportional: float
    integral: float
    gain: float
    attenuation: float = math.inf

    def __post_init__(self) -> None:
        for name in ("proportional", "integral", "gain"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise SpecError(f"the controller's {name} is {value:g}: give one above 0")
        if not self.attenuation > 0.0:
            raise SpecError(f"gamma is {self.attenuation:g}: give one above 0")
        if self.proportional**2 <= 2.0 * self.integral:
            raise SpecError(
                f"Kp^2 is {self.proportional**2:g} and must exceed 2 KI, {2.0 * self.integral:g}: "
                f"lower KI or raise Kp"
            )

    @classmethod
    def with_bandwidth(cls, inertia: float, hertz: float = BANDWIDTH) -> HInfinity:
        """Return gains with three equal poles of the error for an inertia (kg m2 or kg)."""
        if not (math.isfinite(hertz) and hertz > 0.0):
            raise SpecError(f"the controller's bandwidth is {hertz:g} Hz: give one above 0")
        pole = math.tau * hertz
        return cls(2.0 * pole, pole**2, inertia * pole)

    def on(self, inertia: float) -> Controller:
        """Return the equivalent PID with feedforward ``M qd'' + g``, for constant inertia.

        ``M (Kp e' + KI e) + L (e' + Kp e + KI int e)`` with ``L = K + 1/gamma^2``.
        """
        loop = self.gain + 1.0 / self.attenuation**2
        return Controller(
            proportional=inertia * self.integral + loop * self.proportional,
            integral=loop * self.integral,
            derivative=inertia * self.proportional + loop,
        )

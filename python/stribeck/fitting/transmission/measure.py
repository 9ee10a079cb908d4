"""Stiffness, backlash and hysteresis of a transmission, and the side on which friction acts."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import scipy

from stribeck.base.arguments import door
from stribeck.base.errors import FitError
from stribeck.base.shown import Shown
from stribeck.fitting.fit import fit
from stribeck.fitting.transmission.flanks import Flanks, fit_flanks
from stribeck.fitting.transmission.windup import Windup
from stribeck.recording.motion.excerpt import excerpt
from stribeck.recording.recording import Recording
from stribeck.recording.rows import quantisation_step

__all__ = ["Measured", "Transmission", "measure_transmission"]

#: Most samples that are looked at.
_MOST = 60_000
#: A stiffness is told if the ends of its interval are within this factor.
_FACTOR = 1.5
#: Noise of the windup that takes up more than this share of its variance hides the stiffness.
_HIDDEN = 0.5
#: The residual is more than noise if its variance is this many times that of the noise.
_MISFIT = 4.0
#: A gap or a hysteresis is found if it is this many standard errors from zero.
_SIGMAS = 4.0
#: A hysteresis below this share of the torque that winds up the transmission is not told from
#: damping and a curved spring.
_STRAIGHT = 0.01
#: Share of the torque's squared error, beyond noise, that a gap must take away.
_GAP_FALL = 0.05
_LEAST = 200


@dataclass(frozen=True)
class Measured:
    """A measured quantity with its interval of 95 %.

    Attributes
    ----------
    value
        None if it cannot be told, or was not found; `why` then says which.
    low, high
        The interval; the smallest size that would have been found is `high`, where none was.
    """

    value: float | None
    low: float | None
    high: float | None
    unit: str
    why: str | None = None


@dataclass(frozen=True, repr=False)
class Transmission(Shown):
    """What two encoders show of the transmission between them.

    Attributes
    ----------
    windup
        Span of the windup, rad or m.
    resolution
        Smallest windup that is seen, rad or m.
    stiffness, backlash
        N m/rad and rad, or N/m and m.
    hysteresis
        Half the width of the loop of torque over windup, mean over the motion, N m or N. Where the
        joint is held, the friction of the motor is part of it.
    motor_coulomb
        Coulomb friction in front of the transmission, on the side of the motor.
    coulomb
        Coulomb friction of the whole joint, by a fit of `coulomb`.
    lag
        Time by which the encoder of the joint is at least behind that of the motor, s; None where
        none is seen. Viscous friction of the motor has the opposite sign.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(2000) / 100.0
    >>> q, tau = np.sin(3.0 * t), 10.0 * np.sin(t)
    >>> columns = {"time": t, "position": q, "torque": tau, "motor_position": q + tau / 5000.0}
    >>> found = sb.measure_transmission(sb.Recording.from_columns(**columns, gear_ratio=1.0))
    >>> round(found.stiffness.value), found.stiffness.unit
    (5000, 'N m/rad')
    >>> found.backlash.value, found.backlash.why
    (None, 'no gap is seen')
    """

    windup: float
    resolution: float
    stiffness: Measured
    backlash: Measured
    hysteresis: Measured
    motor_coulomb: Measured
    coulomb: Measured
    lag: float | None

    @property
    def motor_share(self) -> float | None:
        """Share of the Coulomb friction on the side of the motor, 0..1; None if not known."""
        motor, whole = self.motor_coulomb, self.coulomb
        if motor.value is None or whole.value is None or whole.value <= 0.0:
            return None
        if whole.low is None or whole.low <= 0.0:
            return None
        return min(motor.value / whole.value, 1.0)

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {**asdict(self), "motor_share": self.motor_share}


@door(recording=("a recording, as `stribeck.read` returns it", Recording))
def measure_transmission(recording: Recording) -> Transmission:
    """Measure the transmission of a recording with encoders on both of its sides.

    The torque of the motor is regressed on the windup, the motor's position minus the joint's, and
    on what acts in front of the spring: friction and inertia of the motor. A spring is the slope, a
    backlash the distance between the two flanks, a hysteresis what depends on the direction in
    which the windup changes. What the data do not determine is None, with the reason.

    Parameters
    ----------
    recording : Recording
        With `motor_position`. The gear ratio is taken as exact.

    Raises
    ------
    FitError
        An encoder or the motor's torque is missing, or too few samples move.

    Examples
    --------
    >>> made = measure_transmission(sb.read("two_encoders.csv", gear_ratio=100))  # doctest: +SKIP
    >>> made.stiffness.value, made.backlash.value  # doctest: +SKIP
    (20013.2, 0.00051)
    """
    windup = Windup.of(excerpt(recording, _MOST))
    if windup.time.size < _LEAST:
        raise FitError(
            f"{recording.path}: {windup.time.size} samples show a windup above its noise, at least "
            f"{_LEAST} are needed"
        )
    unit = "N m" if recording.joint_kind == "revolute" else "N"
    torque_unit = recording.torque_unit or unit
    resolution = _resolution(recording, windup)
    plain = fit_flanks(windup, gap=False)
    assert plain is not None
    wide = fit_flanks(windup, gap=True)
    open_gap = wide is not None and _is_gap(plain, wide, windup, resolution)
    best = wide if wide is not None and open_gap else plain
    stiffness = _stiffness(best, windup, resolution, f"{torque_unit}/{recording.position_unit}")
    known = stiffness.value is not None
    backlash = _backlash(plain, wide, windup, resolution, recording.position_unit, found=open_gap)
    if not known and windup.range >= 2.0 * resolution:
        why = "the stiffness cannot be told"
        backlash = Measured(None, None, None, recording.position_unit, why)
    return Transmission(
        windup=windup.range,
        resolution=resolution,
        stiffness=stiffness,
        backlash=backlash,
        hysteresis=_torque_term(
            best,
            "hysteresis",
            torque_unit,
            known=known,
            least=_STRAIGHT * best.values["stiffness"] * windup.range,
        ),
        motor_coulomb=_motor_coulomb(best, windup, torque_unit, known=known),
        coulomb=_total(recording, torque_unit),
        lag=_lag(best),
    )


def _lag(flanks: Flanks) -> float | None:
    """The least time between both encoders, s; None unless the motor's friction is negative."""
    viscous, error = flanks.values.get("viscous", 0.0), flanks.errors.get("viscous", 0.0)
    if viscous > -_SIGMAS * error or flanks.values["stiffness"] <= 0.0:
        return None
    return -viscous / flanks.values["stiffness"]


def _resolution(recording: Recording, windup: Windup) -> float:
    """Three standard deviations of the windup's noise, and at least a step of either encoder."""
    steps = [
        quantisation_step(x)
        for x in (recording.motor_position, recording.position)
        if x is not None
    ]
    smallest = max(steps, default=0.0) / np.sqrt(12.0)
    return float(3.0 * max(windup.noise, smallest if windup.noise == 0.0 else 0.0))


def _reach(flanks: Flanks) -> float:
    return float(scipy.special.stdtrit(flanks.freedom, 0.975))


def _is_gap(plain: Flanks, wide: Flanks, windup: Windup, resolution: float) -> bool:
    """Whether two flanks with a gap explain what one line does not."""
    gap, error = wide.values["gap"], wide.errors["gap"]
    if wide.values["stiffness"] <= 0.0 or gap <= max(_SIGMAS * error, resolution):
        return False
    noise = windup.time.size * windup.torque_noise**2
    beyond = max(plain.squares - noise, 1e-300)
    fall = (plain.squares - wide.squares) / beyond
    gained = wide.independent * (plain.squares - wide.squares) / max(wide.squares, 1e-300)
    return fall > _GAP_FALL and gained > _SIGMAS**2 * 2.0


def _stiffness(flanks: Flanks, windup: Windup, resolution: float, unit: str) -> Measured:
    value, error = flanks.values["stiffness"], flanks.errors["stiffness"]
    reach = _reach(flanks) * error
    if windup.range < 2.0 * resolution or flanks.explained < 1.0 - _HIDDEN:
        why = (
            f"the windup ({windup.range:.2g}) is not above the resolution of the encoders "
            f"({resolution:.2g})"
        )
        if windup.range >= 2.0 * resolution:
            why = (
                "what the motor's own motion leaves of the windup is not above the noise of the "
                "encoders: load the joint independently of its speed"
            )
        return Measured(None, max(value - reach, 0.0), None, unit, why)
    value, reach = value / flanks.explained, reach / flanks.explained
    low, high = value - reach, value + reach
    expected = windup.torque_noise**2 + (value * windup.noise) ** 2
    if flanks.noise**2 > _MISFIT * expected and flanks.common > 0.0:
        # More than noise is left: the line of the windup over the torque is the other limit.
        high = max(high, value / flanks.common)
    if low <= 0.0 or high > _FACTOR * low:
        why = (
            "torque and windup have too little in common beyond the motor's own motion: load the "
            "joint independently of its speed, or synchronise the encoders"
        )
        return Measured(None, max(low, 0.0), high if high > 0.0 else None, unit, why)
    return Measured(value, low, high, unit)


def _backlash(
    plain: Flanks,
    wide: Flanks | None,
    windup: Windup,
    resolution: float,
    unit: str,
    *,
    found: bool,
) -> Measured:
    if wide is not None and found:
        value, reach = wide.values["gap"], _reach(wide) * wide.errors["gap"]
        return Measured(value, max(value - reach, 0.0), value + reach, unit)
    if not _reverses(plain, windup):
        return Measured(
            None, None, None, unit, "the torque in the transmission does not change its sign"
        )
    high = resolution
    if wide is not None:
        high = max(high, wide.values["gap"] + _reach(wide) * wide.errors["gap"])
    return Measured(None, 0.0, high, unit, "no gap is seen")


def _reverses(flanks: Flanks, windup: Windup) -> bool:
    """Whether the torque in the transmission has both signs, each in 2 % of the samples."""
    own = windup.torque.copy()
    for name, column in (
        ("viscous", windup.velocity),
        ("inertia", windup.acceleration),
        ("coulomb", np.sign(windup.velocity)),
    ):
        own -= flanks.values.get(name, 0.0) * column
    least = 2.0 * windup.torque_noise
    return bool(min((own > least).mean(), (own < -least).mean()) > 0.02)


def _torque_term(
    flanks: Flanks, name: str, unit: str, *, known: bool, least: float = 0.0
) -> Measured:
    if name not in flanks.values or not known:
        why = "the windup does not turn" if known else "the stiffness cannot be told"
        return Measured(None, None, None, unit, why)
    value, error = flanks.values[name], flanks.errors[name]
    reach = _reach(flanks) * error
    if value < max(_SIGMAS * error, least):
        return Measured(None, 0.0, max(value + reach, least), unit, "none is seen")
    return Measured(value, value - reach, value + reach, unit)


def _motor_coulomb(flanks: Flanks, windup: Windup, unit: str, *, known: bool) -> Measured:
    if "coulomb" in flanks.values and known:
        return _torque_term(flanks, "coulomb", unit, known=True)
    why = "the stiffness cannot be told"
    if known:
        held = "the joint is held" if windup.locked else "the motor hardly moves"
        why = f"{held}: friction of the motor is part of the hysteresis"
    return Measured(None, None, None, unit, why)


def _total(recording: Recording, unit: str) -> Measured:
    """Coulomb friction of the whole joint."""
    if not recording.moving.any():
        return Measured(None, None, None, unit, "the joint does not move")
    try:
        estimate = fit("coulomb", recording).estimates["coulomb_friction"]
    except FitError as error:
        return Measured(None, None, None, unit, str(error))
    low, high = estimate.ci95 if estimate.ci95 is not None else (None, None)
    return Measured(estimate.value, low, high, unit)

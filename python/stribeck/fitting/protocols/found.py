"""The test-bench protocols that a recording holds."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from stribeck.base.arguments import door
from stribeck.fitting.methods.stretches import Search, constant_speed
from stribeck.fitting.protocols.breakaway import breakaways, dependence
from stribeck.fitting.protocols.coast_down import coast_downs
from stribeck.fitting.protocols.loops import presliding_loops
from stribeck.fitting.protocols.rests import is_measured, still_speed
from stribeck.recording.recording import Recording

__all__ = ["Protocol", "found_protocols"]

#: Least share of the motion that passes at constant speed take.
_PASSES = 0.5
#: From this number of samples on, a quick look decides whether passes are sought.
_LONG = 30_000


@dataclass(frozen=True)
class Protocol:
    """A protocol that was found.

    Attributes
    ----------
    protocol
        ``plateau``, ``breakaway``, ``presliding`` or ``coast_down``.
    count
        How often.
    says
        What it shows, in one line.
    method
        Of `stribeck points`, which turns it into points.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(4000) / 100.0
    >>> v = np.array([0.2, -0.2, 0.5, -0.5, 1.0, -1.0, 0.1, -0.1]).repeat(500)
    >>> torque, position = v + 2.0 * np.sign(v), np.cumsum(v) / 100.0
    >>> r = sb.Recording.from_columns(time=t, position=position, velocity=v, torque=torque)
    >>> (found,) = sb.found_protocols(r)
    >>> found.protocol, found.count, found.method
    ('plateau', 8, 'segments')
    >>> found.says
    'passes at constant speed, 4 forward and 4 backward, 0.1 to 1 rad/s'
    """

    protocol: str
    count: int
    says: str
    method: str

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return asdict(self)


@door(recording=("a recording, as `stribeck.read` returns it", Recording))
def found_protocols(recording: Recording) -> tuple[Protocol, ...]:
    """The test-bench protocols of a recording, by what they show.

    Examples
    --------
    >>> [p.protocol for p in found_protocols(sb.read("bench.csv"))]  # doctest: +SKIP
    ['plateau', 'breakaway']
    """
    if recording.averaged:
        return ()
    found = (_plateaux(recording), _breakaways(recording), _loops(recording), _coasts(recording))
    return tuple(protocol for protocol in found if protocol is not None)


def _plateaux(recording: Recording) -> Protocol | None:
    if not is_measured(recording) or recording.position is None:
        return None
    speed = np.abs(recording.velocity_smooth)
    moving = speed > still_speed(recording)
    if len(recording) > _LONG:
        # Straight lines take seconds to find: first see whether the speed stays the same at all.
        later = max(1, int(Search.shortest * recording.rate_hz))
        change = np.abs(speed[later:] - speed[:-later])
        steady = moving[later:] & (change < 2.0 * Search.tolerance * speed[later:])
        if steady.sum() < 0.5 * _PASSES * moving.sum():
            return None
    lines = constant_speed(recording.time, recording.position, recording.segment)
    # The fastest part of any smooth motion is nearly constant, too: a fifth of a sine.
    if not lines or sum(line.rows for line in lines) < _PASSES * float(moving.sum()):
        return None
    speeds = sorted(abs(line.velocity) for line in lines)
    forward = sum(line.velocity > 0.0 for line in lines)
    says = (
        f"passes at constant speed, {forward} forward and {len(lines) - forward} backward, "
        f"{speeds[0]:.3g} to {speeds[-1]:.3g} {recording.position_unit}/s"
    )
    return Protocol("plateau", len(lines), says, "segments")


def _breakaways(recording: Recording) -> Protocol | None:
    found = breakaways(recording)
    if not found:
        return None
    sizes = sorted(abs(b.torque) for b in found)
    says = f"breakaways from rest at {sizes[0]:.3g} to {sizes[-1]:.3g} {recording.torque_unit}"
    if recording.load_torque is None:
        says += ", gravity included"
    for name, of in dependence(found).items():
        if of.slope is not None and of.low is not None and of.high is not None:
            if of.low <= 0.0 <= of.high:
                says += f"; no dependence on the {name} is seen"
                continue
            says += (
                f"; {of.slope:+.2g} ({of.low:.2g} to {of.high:.2g}) {recording.torque_unit} per "
                f"tenfold {name}"
            )
    return Protocol("breakaway", len(found), says, "breakaway")


def _loops(recording: Recording) -> Protocol | None:
    found = presliding_loops(recording)
    if not found:
        return None
    stiffness = sorted(loop.stiffness for loop in found)
    unit = f"{recording.torque_unit}/{recording.position_unit}"
    says = f"presliding loops, stiffness {stiffness[0]:.4g} to {stiffness[-1]:.4g} {unit}"
    return Protocol("presliding", len(found), says, "presliding")


def _coasts(recording: Recording) -> Protocol | None:
    found = coast_downs(recording)
    if not found:
        return None
    fastest = max(abs(one.fastest) for one in found)
    says = f"coast-downs from {fastest:.3g} {recording.position_unit}/s or less"
    if recording.load_torque is None:
        says += "; with the inertia they give friction"
    return Protocol("coast_down", len(found), says, "coast_down")

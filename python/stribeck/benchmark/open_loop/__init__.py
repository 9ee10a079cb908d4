"""Recordings of a joint that is moved along a given path: analytic motion, no control.

Nothing of the product's laws is imported and none of their forms is reused, so that a fit can only
succeed by naming the right cause, never by sharing the formula. The forms used here, with ``x``
scaled and the amplitude searched so that the effect has the size asked for:

stribeck
    Hess-Soom ``1/(1 + x^2)``, ``sech x``, or a monotone PCHIP table of abs(v): the usual stretched
    exponential is only one of many shapes that fall with speed.
nonlinear_viscous
    ``atan`` or ``log1p`` saturation, or churning ``x^2/(1 + x)``; never a power.
direction
    Both coefficients differ by the sign of v. What an offset explains does not count as size.
load
    Hyperbola ``sqrt(1 + x^2) - 1`` or rational ``x^2/(1 + x)`` of abs(load): flat, then linear.
quadrant
    Tooth friction ``abs(load)`` times a share that is uneven for a driving and a driven joint and
    evens out with speed as ``1/(1 + x)``. What friction per load takes up does not count as size.
temperature_viscous
    Vogel ``exp(A/(T + 95) - A/(Tm + 95))`` or Arrhenius in kelvin, as lubricants thin.
temperature_dry
    Softplus or a piecewise-linear table of T.
presliding
    Maxwell slip: 24 elastic-slip elements with nonlocal memory, loading curve
    ``1 - (1 - x/xm)^n``; no bristle equation. On a grid 8 to 16 times finer than the rows.
position
    Two or three Gaussian bumps along the stroke.
offset
    A constant in the torque channel.
inertia, gravity
    The given load_torque lacks a part of the true one.
gain
    The recording multiplies the current by a nominal torque constant, the joint gets the true one.
saturation
    The current that a torque takes where iron saturates: Froelich's ``T/(1 - abs T/b)`` or
    ``T/sqrt(1 - (T/b)^2)``; the recording multiplies it by the torque constant of small currents.
spring
    A cable pack that stiffens (``sinh``), gives way (``atan``) or hangs slack (softplus), its rest
    position anywhere; its mean over the stroke is taken out.
ripple
    ``sin(x + b sin(x + c))`` of the angle of a magnet or a pole: more than two harmonics, without
    its mean.
drift
    Run-in ``t/(t + c)``, wear ``log(1 + t/c)`` or a power law; never an exponential.
delay
    The torque channel shows the joint at t - tau. The motion is analytic in t, so the joint is
    evaluated there and nothing is interpolated, however fine tau is.

The motion is a piecewise analytic mixture: multi-sines, trapezoid and quintic moves with dwells,
slow scans, cosine strokes with differing reversal accelerations; the payload changes in dwells.
Everything is drawn from ``numpy.random.default_rng(seed)``. `outside` holds effects that are no
part of the library.
"""

from __future__ import annotations

from stribeck.benchmark.open_loop.effects import CAPS, EFFECTS, IMPLIED, LIMITS
from stribeck.benchmark.open_loop.outside import OUTSIDE
from stribeck.benchmark.open_loop.record import Recording, make, record, sample

__all__ = [
    "CAPS",
    "EFFECTS",
    "IMPLIED",
    "LIMITS",
    "OUTSIDE",
    "Recording",
    "make",
    "record",
    "sample",
]

"""Recordings of a joint moved along a given path: analytic motion, no control.

No law of the package is imported and none of their formulas is reused, so that a fit succeeds only
with the correct cause and not with the same formula. The formulas are listed here; ``x`` is scaled,
and the amplitude is searched so that the effect has the wanted size:

stribeck
    Hess-Soom ``1/(1 + x^2)``, ``sech x``, or a monotone PCHIP table of abs(v): the usual stretched
    exponential is only one of many shapes that fall with speed.
nonlinear_viscous
    ``atan`` or ``log1p`` saturation, or churning ``x^2/(1 + x)``; never a power.
direction
    Both coefficients depend on the sign of v. The part explained by an offset is not included in
    the size.
load
    Hyperbola ``sqrt(1 + x^2) - 1`` or rational ``x^2/(1 + x)`` of abs(load): flat, then linear.
quadrant
    Tooth friction ``abs(load)`` times a share that is uneven for a driving and a driven joint and
    evens out with speed as ``1/(1 + x)``. The part explained by friction per load is not included
    in the size.
temperature_viscous
    Vogel ``exp(A/(T + 95) - A/(Tm + 95))`` or Arrhenius in kelvin, for the viscosity of a
    lubricant.
temperature_dry
    Softplus or a piecewise-linear table of T.
presliding
    Maxwell slip: 24 elastic-slip elements with nonlocal memory, loading curve
    ``1 - (1 - x/xm)^n``; no bristle equation. It is evaluated on a grid 8 to 16 times finer than
    the samples.
position
    Two or three Gaussian bumps along the stroke.
offset
    A constant in the torque channel.
inertia, gravity
    The given load_torque lacks a part of the true one.
gain
    The recorded torque is computed with a nominal torque constant that differs from the true one.
saturation
    The current for a torque if the iron saturates: Froelich's ``T/(1 - abs T/b)`` or
    ``T/sqrt(1 - (T/b)^2)``; the recording multiplies it by the torque constant of small currents.
spring
    A cable pack that stiffens (``sinh``), softens (``atan``) or hangs slack (softplus), with a
    random rest position; the mean over the stroke is subtracted.
ripple
    ``sin(x + b sin(x + c))`` of the angle of a magnet or a pole: more than two harmonics, with the
    mean subtracted.
drift
    Run-in ``t/(t + c)``, wear ``log(1 + t/c)`` or a power law; never an exponential.
delay
    The torque channel is that of the joint at t - tau. The motion is an analytic function of t, so
    no interpolation is needed.

The motion is a piecewise analytic mixture: multi-sines, trapezoid and quintic moves with dwells,
slow scans, cosine strokes with different reversal accelerations; the payload changes in dwells.
All random numbers come from ``numpy.random.default_rng(seed)``. `outside` has the effects outside
the library.
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

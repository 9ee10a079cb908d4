"""Two laws as a skilled user writes them with numpy and numba."""

from __future__ import annotations

import numba
import numpy as np

#: Parameters a1..a5 of `bittencourt_a` (review of 25 models, table 1) and a1..a7 of `lugre`.
BITTENCOURT_A = (6.1, 3.2, 0.07, 1.7, 4.9)
LUGRE = (4.0e3, 12.0, 4.9, 6.1, 9.3, 0.07, 1.7)


def bittencourt_a(velocity, parameters, out, work):
    """Torque by numpy, in place; `work` has the shape of `velocity`."""
    a1, a2, a3, a4, a5 = parameters
    np.divide(velocity, a3, out=work)
    np.abs(work, out=work)
    np.power(work, a4, out=work)
    np.negative(work, out=work)
    np.exp(work, out=work)
    np.multiply(work, a2, out=work)
    np.add(work, a1, out=work)
    np.sign(velocity, out=out)
    np.multiply(work, out, out=work)
    np.multiply(velocity, a5, out=out)
    np.add(work, out, out=out)
    return out


def bittencourt_a_gradient(velocity, parameters):
    """Torque and its derivatives by numpy."""
    a1, a2, a3, a4, a5 = parameters
    ratio = np.abs(velocity) / a3
    moving = ratio > 0.0
    power = ratio**a4
    curve = np.exp(-power)
    direction = np.sign(velocity)
    logarithm = np.log(ratio, where=moving, out=np.zeros_like(ratio))
    torque = (a1 + a2 * curve) * direction + a5 * velocity
    fall = a2 * curve * power * direction
    slopes = np.column_stack(
        [direction, curve * direction, fall * a4 / a3, -fall * logarithm, velocity]
    )
    return torque, slopes


@numba.njit(error_model="numpy")
def lugre(velocity, dt, parameters):
    """Torque of the exact step for a velocity that is held over it."""
    s0, s1, s2, coulomb, static, stribeck, exponent = parameters
    torque = np.empty_like(velocity)
    z = 0.0
    for i in range(velocity.size):
        v = velocity[i]
        speed = abs(v)
        g = coulomb + (static - coulomb) * np.exp(-((speed / stribeck) ** exponent))
        share = -np.expm1(-s0 * speed * dt / g)
        target = g / s0 * np.sign(v)
        slip = s0 * speed / g * (1.0 - share) * (target - z)
        z += share * (target - z)
        torque[i] = s0 * z + s1 * slip + s2 * v
    return torque


@numba.njit(error_model="numpy")
def lugre_gradient(velocity, dt, parameters):
    """The same with its derivatives by all seven parameters, row by row."""
    s0, s1, s2, coulomb, static, stribeck, exponent = parameters
    n = velocity.size
    torque = np.empty(n)
    slopes = np.empty((n, 7))
    dg = np.zeros(7)
    dz = np.zeros(7)
    z = 0.0
    for i in range(n):
        v = velocity[i]
        speed = abs(v)
        direction = np.sign(v)
        ratio = speed / stribeck
        power = ratio**exponent
        curve = np.exp(-power)
        g = coulomb + (static - coulomb) * curve
        fall = (static - coulomb) * curve * power
        dg[3] = 1.0 - curve
        dg[4] = curve
        dg[5] = fall * exponent / stribeck
        dg[6] = -fall * np.log(ratio) if ratio > 0.0 else 0.0
        pace = s0 * speed / g
        left = np.exp(-pace * dt)
        share = -np.expm1(-pace * dt)
        target = g / s0 * direction
        way = target - z
        slip = pace * left * way
        z += share * way
        torque[i] = s0 * z + s1 * slip + s2 * v
        for k in range(7):
            dpace = -pace / g * dg[k]
            dtarget = dg[k] / s0 * direction
            if k == 0:
                dpace += speed / g
                dtarget -= target / s0
            dway = dtarget - dz[k]
            dleft = -dt * left * dpace
            dslip = dpace * left * way + pace * (dleft * way + left * dway)
            dz[k] += -dleft * way + share * dway
            slope = s0 * dz[k] + s1 * dslip
            if k == 0:
                slope += z
            elif k == 1:
                slope += slip
            elif k == 2:
                slope += v
            slopes[i, k] = slope
    return torque, slopes

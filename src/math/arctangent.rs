//! Arc tangent.

use super::format::Format;

/// Arc tangent: `atan a = c + atan t` with `|t| <= sqrt(2) - 1`, where `c` is 0, pi/4 or pi/2 and
/// `t` is `a`, `(a - 1) / (a + 1)` or `-1 / a`.
#[inline(always)]
pub fn atan<F: Format>(x: F) -> F {
    let (half, one) = (F::of(0.5), F::of(1.0));
    let [right_angle, right_angle_low] = F::PI_HALF_PAIR;
    let size = x.abs();

    // sqrt(2) - 1 and sqrt(2) + 1
    let small = size < F::of(0.41421357);
    let large = size > F::of(2.4142137);
    let (below, above) = (size - one, size + one);
    let numerator = if small { size } else { below };
    let numerator = if large { -one } else { numerator };
    let denominator = if small { one } else { above };
    let denominator = if large { size } else { denominator };
    let t = numerator / denominator;
    let z = t * t;

    // Corrects the rounding error of the quotient: 1 / (a + 1) is (1 - t) / 2, and the derivative
    // of atan t is nearly 1 - t^2.
    let lost = (size - (below + one)) - t * (size - (above - one));
    let correction = half * lost * ((one - t) * (one - z));

    let angle = if large { right_angle } else { half * right_angle };
    let low = if large { right_angle_low } else { half * right_angle_low + correction };
    let rest = t * (z * F::atan_series(z));
    let value = if small { t + rest } else { angle + (t + (rest + low)) };
    value.copysign(x)
}

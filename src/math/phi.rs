//! The weights of an exponential integrator: `phi_k(x) = sum_j x^j / (j + k)!`.

use super::exponential::{exp, expm1, half_expm1};
use super::format::Format;

/// `phi_k(x)`, with `phi_0 = e^x` and `phi_(k+1) = (phi_k - 1/k!) / x`; infinite where `e^x` is.
#[inline(always)]
pub fn phi<F: Format>(order: u8, x: F) -> F {
    match order {
        0 => exp(x),
        1 => phi_1(x),
        2 => phi_2(x),
        // Near zero the recurrence cancels.
        _ if x.abs() < F::of(0.5) => series(order, x),
        _ => recurrence(order, x),
    }
}

/// `(e^x - 1) / x`.
#[inline(always)]
fn phi_1<F: Format>(x: F) -> F {
    let value = expm1(x) / x;
    let value = if x == F::INFINITY { x } else { value };
    if x == F::of(0.0) { F::of(1.0) } else { value }
}

/// `(e^x - 1 - x) / x^2`.
#[inline(always)]
fn phi_2<F: Format>(x: F) -> F {
    let (high, low) = half_expm1(x);
    let beyond = (F::of(2.0) * high - x) + F::of(2.0) * low;
    let value = beyond / x / x;
    let value = if x == F::INFINITY { x } else { value };
    if x.abs() < F::EXPM1_LINEAR { F::of(0.5) } else { value }
}

fn recurrence<F: Format>(order: u8, x: F) -> F {
    (2..order).fold(phi_2(x), |phi, k| (phi - F::inverse_factorial(k.into())) / x)
}

/// The series. Even and odd terms are summed separately, so that the two sums run in parallel.
fn series<F: Format>(order: u8, x: F) -> F {
    let square = x * x;
    let term = |j: usize| F::inverse_factorial(j + usize::from(order));
    let (mut even, mut odd) = (F::of(0.0), F::of(0.0));
    for j in (0..F::PHI_PAIRS).rev() {
        even = even * square + term(2 * j);
        odd = odd * square + term(2 * j + 1);
    }
    even + x * odd
}

//! Divided differences of a recorded channel, in which the noise is left and the motion is not.

use std::vec::Vec;

use crate::math::f64::sqrt;

/// Divided differences of `order` 2 to 5 of the `values` at `times`, scaled so that white noise of
/// standard deviation 1 gives differences of standard deviation 1; None for another order.
///
/// Samples among which the signal is constant are left out: a servo that is off, or a sensor at its
/// limit, has no noise.
///
/// ```
/// # use stribeck::identify::divided_differences;
/// let times = [0.0, 0.5, 1.0, 1.5];
/// let found = divided_differences(&times, &[1.0, 2.0, 0.0, 0.0], 2).expect("order 2");
/// // Binomial on an even grid: (1, -2, 1) over the root of 6.
/// assert!((found[0] + 3.0 / f64::sqrt(6.0)).abs() < 1e-15);
/// assert!((found[1] - 2.0 / f64::sqrt(6.0)).abs() < 1e-15);
/// ```
#[must_use]
pub fn divided_differences(times: &[f64], values: &[f64], order: usize) -> Option<Vec<f64>> {
    match order {
        2 => Some(differences::<3>(times, values)),
        3 => Some(differences::<4>(times, values)),
        4 => Some(differences::<5>(times, values)),
        5 => Some(differences::<6>(times, values)),
        _ => None,
    }
}

/// The same over windows of `N` samples, one more than the order.
fn differences<const N: usize>(times: &[f64], values: &[f64]) -> Vec<f64> {
    let even = if N % 2 == 1 { 1.0 } else { -1.0 };
    let mut found = Vec::with_capacity(values.len());
    for (t, x) in times.windows(N).zip(values.windows(N)) {
        if x.iter().all(|value| *value == x[0]) {
            continue;
        }
        let mut weights = [0.0; N];
        for (j, weight) in weights.iter_mut().enumerate() {
            let mut product = if j % 2 == 0 { even } else { -even };
            for m in (0..N).filter(|m| *m != j) {
                product *= t[j.max(m)] - t[j.min(m)];
            }
            *weight = 1.0 / product;
        }
        let size = sqrt(weights.iter().map(|weight| weight * weight).sum());
        found.push(weights.iter().zip(x).map(|(weight, x)| weight / size * x).sum());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_lower_degree_leaves_nothing() {
        let times = [0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.9];
        for order in 2..=5 {
            let values = times.map(|t| 1.0 + core::iter::repeat_n(t, order - 1).product::<f64>());
            let found = divided_differences(&times, &values, order).expect("a known order");
            assert_eq!(found.len(), times.len() - order);
            assert!(found.iter().all(|x| x.abs() < 1e-12), "{found:?}");
        }
    }

    #[test]
    fn constant_stretches_are_left_out() {
        let times = [0.0, 1.0, 2.0, 3.0, 4.0];
        let found = divided_differences(&times, &[7.0, 7.0, 7.0, 7.0, 8.0], 2);
        assert_eq!(found.expect("order 2").len(), 1);
        assert_eq!(divided_differences(&times[..2], &[1.0, 2.0], 2), Some(Vec::new()));
        assert_eq!(divided_differences(&times, &times, 6), None);
    }
}

//! A quantity that follows a recorded channel with a first-order lag.

use std::vec::Vec;

use crate::math::f64::expm1;

/// The values behind a first-order lag, at each sample; `steps` are the times since the sample
/// before (s). One that is not above zero begins anew, at rest. None unless the `lag` (s) is above
/// zero.
///
/// Each step is exact for a value that is constant within it.
///
/// ```
/// # use stribeck::identify::first_order;
/// let settled = first_order(&[0.0, 1.0, 1.0], &[0.0, 2.0, 2.0], 1e-3);
/// assert_eq!(settled, Some(vec![0.0, 2.0, 2.0]));
/// ```
#[must_use]
pub fn first_order(steps: &[f64], values: &[f64], lag: f64) -> Option<Vec<f64>> {
    let usable = lag > 0.0 && lag.is_finite();
    usable.then(|| {
        let mut late = 0.0;
        let follow = |(&step, &now): (&f64, &f64)| {
            let share = if step > 0.0 { -expm1(-step / lag) } else { 1.0 };
            late = share * now + (1.0 - share) * late;
            late
        };
        steps.iter().zip(values).map(follow).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_a_step_exponentially_whatever_the_sampling() {
        let fine = first_order(&[0.0, 0.1, 0.1, 0.1], &[0.0, 1.0, 1.0, 1.0], 0.4).expect("valid");
        let coarse = first_order(&[0.0, 0.3], &[0.0, 1.0], 0.4).expect("valid");
        assert!((fine[3] - coarse[1]).abs() < 1e-15);
        assert!((coarse[1] - 0.527_633_447_258_985).abs() < 1e-15);
    }

    #[test]
    fn begins_anew_behind_a_gap() {
        let found = first_order(&[0.0, 0.1, 0.0], &[1.0, 2.0, 5.0], 0.1).expect("valid");
        assert_eq!(found[2].to_bits(), 5.0_f64.to_bits());
    }

    #[test]
    fn refuses_a_lag_that_is_none() {
        for lag in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert!(first_order(&[0.0], &[1.0], lag).is_none());
        }
    }
}

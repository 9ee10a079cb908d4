//! The torque of a spring between a measured motion and an inertia that oscillates on it.

use std::vec;
use std::vec::Vec;

use crate::math::f64::{exp, sin_cos, sqrt};

/// A drive train that resonates: `y'' = w^2 (u - y) - 2 d w y'`, with the load torque `u` of a rigid
/// one and the torque `y` of its spring.
///
/// Each step is exact for a load torque that changes linearly within it, whatever its length. It
/// begins as if the load torque had always changed as in the first quarter of a period.
///
/// Source: Spong 1987, *Modeling and Control of Elastic Joint Robots*, section 2, with a damper
/// beside the spring.
///
/// ```
/// # use stribeck::identify::Resonance;
/// let slow = Resonance::new(1.0, 0.1).expect("a resonance");
/// let held = slow.curvature(&[0.0, 0.1, 0.1], &[3.0, 3.0, 3.0]);
/// assert_eq!(held, [0.0; 3]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Resonance {
    frequency: f64,
    damping: f64,
}

impl Resonance {
    /// The resonance with this period without damping (s) and share of critical damping; None
    /// unless the period is above zero and the share between zero and one.
    #[must_use]
    pub fn new(period: f64, damping: f64) -> Option<Self> {
        let usable = period > 0.0 && period.is_finite() && damping > 0.0 && damping < 1.0;
        usable.then(|| Self { frequency: core::f64::consts::TAU / period, damping })
    }

    /// Second derivative of the torque of the spring at each sample (T/s2). `steps` are the times
    /// since the sample before (s); one that is not above zero begins anew.
    #[must_use]
    pub fn curvature(&self, steps: &[f64], load: &[f64]) -> Vec<f64> {
        let &Self { frequency, damping } = self;
        let behind = 2.0 * damping / frequency;
        let (mut torque, mut rate, mut before) = (0.0, 0.0, 0.0);
        let mut turn = Turn::over(*self, 0.0);
        let mut course = Vec::with_capacity(load.len());
        for (row, (&step, &now)) in steps.iter().zip(load).enumerate() {
            if step > 0.0 {
                if step.to_bits() != turn.step.to_bits() {
                    turn = Turn::over(*self, step);
                }
                let slope = (now - before) / step;
                // The torque follows a ramp behind it; what deviates from that decays.
                let [off, drift] = turn.of([torque - (before - slope * behind), rate - slope]);
                (torque, rate) = (now - slope * behind + off, slope + drift);
            } else {
                let [first, slope] = self.beginning(&steps[row..], &load[row..]);
                (torque, rate) = (first - slope * behind, slope);
            }
            before = now;
            course.push(frequency * (frequency * (now - torque) - 2.0 * damping * rate));
        }
        course
    }

    /// Value and slope with which the load torque begins: of the straight line through the first
    /// quarter of a period.
    fn beginning(&self, steps: &[f64], load: &[f64]) -> [f64; 2] {
        let quarter = 0.25 * core::f64::consts::TAU / self.frequency;
        let mut times = vec![0.0];
        let mut time = 0.0;
        for &step in steps.iter().skip(1).take_while(|&&step| step > 0.0) {
            time += step;
            if time > quarter {
                break;
            }
            times.push(time);
        }
        line(&times, &load[..times.len()])
    }
}

/// The value at the first of these samples and the slope of the straight line through them, by
/// least squares.
fn line(times: &[f64], values: &[f64]) -> [f64; 2] {
    let count = times.len() as f64;
    let mean = |all: &[f64]| all.iter().sum::<f64>() / count;
    let (time, value) = (mean(times), mean(values));
    let (mut spread, mut together) = (0.0, 0.0);
    for (t, x) in times.iter().zip(values) {
        spread += (t - time) * (t - time);
        together += (t - time) * (x - value);
    }
    let slope = if spread > 0.0 { together / spread } else { 0.0 };
    [value - slope * time, slope]
}

/// What a step makes of a deviation and its rate without a load.
struct Turn {
    step: f64,
    rows: [[f64; 2]; 2],
}

impl Turn {
    fn over(Resonance { frequency, damping }: Resonance, step: f64) -> Self {
        let damped = frequency * sqrt(1.0 - damping * damping);
        let (sine, cosine) = sin_cos(damped * step);
        let left = exp(-damping * frequency * step);
        let mixed = damping * frequency / damped * sine;
        let rows = [
            [left * (cosine + mixed), left * sine / damped],
            [-left * frequency * frequency / damped * sine, left * (cosine - mixed)],
        ];
        Self { step, rows }
    }

    fn of(&self, [off, drift]: [f64; 2]) -> [f64; 2] {
        self.rows.map(|[by_off, by_drift]| by_off * off + by_drift * drift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy 1.16: `cont2discrete` of the same equation with `method="foh"`, then `dlsim`. The load
    /// torque begins with the rest of a third of a period.
    #[test]
    fn equals_an_independent_implementation() {
        let load: Vec<f64> = (0..14).map(|i: i32| f64::from((i - 4).max(0).pow(2) % 7)).collect();
        let mut steps = [0.01; 14];
        steps[0] = 0.0;
        let found = Resonance::new(0.1, 0.2).expect("valid").curvature(&steps, &load);
        for (mine, other) in found.iter().zip(SCIPY) {
            assert!((mine - other).abs() < 1e-9 * other.abs().max(1.0), "{mine} {other}");
        }
    }

    const SCIPY: [f64; 14] = [
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        3265.8567267221906,
        11234.574507877907,
        -2691.4800031274262,
        -6081.929247197435,
        -132.96947365550477,
        -11790.432794482313,
        -10343.189215779119,
        807.6518575572809,
        15739.337168058983,
    ];

    #[test]
    fn does_not_depend_on_how_a_ramp_is_sampled() {
        let resonance = Resonance::new(0.1, 0.2).expect("valid");
        let fine = resonance.curvature(&[0.0, 0.1, 0.01, 0.01, 0.01], &[0.0, 0.0, 1.0, 2.0, 3.0]);
        let coarse = resonance.curvature(&[0.0, 0.1, 0.03], &[0.0, 0.0, 3.0]);
        assert!((fine[4] - coarse[2]).abs() < 1e-9);
    }

    #[test]
    fn a_load_torque_that_begins_on_a_slope_swings_nothing() {
        let resonance = Resonance::new(0.1, 0.2).expect("valid");
        let course = resonance.curvature(&[0.0, 0.01, 0.01, 0.01], &[1.0, 2.0, 3.0, 4.0]);
        assert!(course.iter().all(|x| x.abs() < 1e-9), "{course:?}");
    }

    #[test]
    fn refuses_what_does_not_oscillate() {
        for (period, damping) in [(0.0, 0.1), (-1.0, 0.1), (1.0, 0.0), (1.0, 1.0), (f64::NAN, 0.1)]
        {
            assert!(Resonance::new(period, damping).is_none());
        }
    }
}

//! The torque of a spring between a measured motion and an inertia that oscillates on it.

use std::vec;
use std::vec::Vec;

use crate::math::f64::{exp, sin_cos, sqrt};

/// A drive train that resonates: `y'' = w^2 (u - y - y^3/h^2) - 2 d w y'`, with the load torque `u`
/// of a rigid one, and the torque `y` of its spring if it were linear.
///
/// A spring hardens with a cubic part, which is as large as the linear one at the torque `h`. Each
/// step is exact for a linear spring and a load torque that changes linearly within it, whatever its
/// length; on a hardening spring it is divided, and of second order. The motion begins as if the load
/// torque had always changed as in the first quarter of a period.
///
/// Sources: Spong 1987, *Modeling and Control of Elastic Joint Robots*, section 2, with a damper
/// beside the spring; Tuttle and Seering 1996, *A Nonlinear Model of a Harmonic Drive Gear
/// Transmission*, equation 10, for the cubic part.
///
/// ```
/// # use stribeck::identify::Resonance;
/// let slow = Resonance::new(1.0, 0.1, None).expect("a resonance");
/// let held = slow.curvature(&[0.0, 0.1, 0.1], &[3.0, 3.0, 3.0]);
/// assert_eq!(held, [0.0; 3]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Resonance {
    frequency: f64,
    damping: f64,
    hardening: Option<f64>,
}

/// Most radians of an oscillation on a hardening spring in a part of a step.
const LONGEST: f64 = 0.3;
/// Most parts of a step.
const MOST_PARTS: f64 = 256.0;
/// Newton steps to the torque at which a spring begins: they double the digits each.
const NEWTON: usize = 30;

/// Torque of the spring if it were linear, and its rate.
type State = [f64; 2];

impl Resonance {
    /// The resonance with this period without damping (s), share of critical damping, and torque at
    /// which the spring carries twice that of a linear one; None unless the period is above zero,
    /// the share between zero and one, and that torque above zero.
    #[must_use]
    pub fn new(period: f64, damping: f64, hardening: Option<f64>) -> Option<Self> {
        let usable = period > 0.0 && period.is_finite() && damping > 0.0 && damping < 1.0;
        let hardens = hardening.is_none_or(|torque| torque > 0.0 && torque.is_finite());
        let frequency = core::f64::consts::TAU / period;
        (usable && hardens).then_some(Self { frequency, damping, hardening })
    }

    /// Second derivative of the torque of the spring, if it were linear, at each sample (T/s2).
    /// `steps` are the times since the sample before (s); one that is not above zero begins anew.
    #[must_use]
    pub fn curvature(&self, steps: &[f64], load: &[f64]) -> Vec<f64> {
        let &Self { frequency, damping, .. } = self;
        let (mut state, mut before) = ([0.0, 0.0], 0.0);
        let mut turn = Turn::over(*self, 0.0);
        let mut course = Vec::with_capacity(load.len());
        for (row, (&step, &now)) in steps.iter().zip(load).enumerate() {
            state = if step > 0.0 {
                self.stepped(state, before, now, step, &mut turn)
            } else {
                self.beginning(&steps[row..], &load[row..])
            };
            before = now;
            let [torque, rate] = state;
            let carried = torque + self.cubic(torque);
            course.push(frequency * (frequency * (now - carried) - 2.0 * damping * rate));
        }
        course
    }

    /// The state after a step in which the load torque changes from `before` to `now`.
    ///
    /// The cubic part is taken from the load torque: first as it was, then as it has become.
    fn stepped(&self, state: State, before: f64, now: f64, step: f64, turn: &mut Turn) -> State {
        let count = self.parts(state[0], before, now, step);
        let part = step / count;
        if part.to_bits() != turn.step.to_bits() {
            *turn = Turn::over(*self, part);
        }
        let change = (now - before) / count;
        let (mut state, mut done) = (state, 0.0);
        while done < count {
            let from = before + change * done;
            let until = if done + 1.0 < count { from + change } else { now };
            let cubic = self.cubic(state[0]);
            let mut ahead = self.along(state, [from - cubic, until - cubic], turn);
            if self.hardening.is_some() {
                ahead = self.along(state, [from - cubic, until - self.cubic(ahead[0])], turn);
            }
            state = ahead;
            done += 1.0;
        }
        state
    }

    /// The state of a linear spring after a part of a step, in which the load torque changes linearly
    /// `from` one value `until` another: the torque follows a ramp behind it; what deviates decays.
    fn along(&self, [torque, rate]: State, [from, until]: [f64; 2], turn: &Turn) -> State {
        let slope = (until - from) / turn.step;
        let behind = slope * (2.0 * self.damping / self.frequency);
        let [off, drift] = turn.of([torque - (from - behind), rate - slope]);
        [until - behind + off, slope + drift]
    }

    /// Number of parts of a step, a power of two; one for a linear spring.
    fn parts(&self, torque: f64, before: f64, now: f64, step: f64) -> f64 {
        let Some(hardening) = self.hardening else { return 1.0 };
        let largest = torque.abs().max(before.abs()).max(now.abs()) / hardening;
        let fastest = self.frequency * sqrt(1.0 + 3.0 * largest * largest);
        let mut count = 1.0;
        while step * fastest > LONGEST * count && count < MOST_PARTS {
            count *= 2.0;
        }
        count
    }

    /// The cubic part of the spring's torque.
    fn cubic(&self, torque: f64) -> f64 {
        self.hardening.map_or(0.0, |hardening| {
            let ratio = torque / hardening;
            torque * ratio * ratio
        })
    }

    /// The state in which the load torque begins: behind the straight line through its first quarter
    /// of a period.
    fn beginning(&self, steps: &[f64], load: &[f64]) -> State {
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
        let [first, slope] = line(&times, &load[..times.len()]);
        let carried = first - slope * 2.0 * self.damping / self.frequency;
        let Some(hardening) = self.hardening else { return [carried, slope] };
        let mut torque = carried;
        for _ in 0..NEWTON {
            let ratio = torque / hardening;
            let off = torque + self.cubic(torque) - carried;
            torque -= off / (1.0 + 3.0 * ratio * ratio);
        }
        let ratio = torque / hardening;
        [torque, slope / (1.0 + 3.0 * ratio * ratio)]
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
    fn over(Resonance { frequency, damping, .. }: Resonance, step: f64) -> Self {
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
        let found = Resonance::new(0.1, 0.2, None).expect("valid").curvature(&steps, &load);
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
        let resonance = Resonance::new(0.1, 0.2, None).expect("valid");
        let fine = resonance.curvature(&[0.0, 0.1, 0.01, 0.01, 0.01], &[0.0, 0.0, 1.0, 2.0, 3.0]);
        let coarse = resonance.curvature(&[0.0, 0.1, 0.03], &[0.0, 0.0, 3.0]);
        assert!((fine[4] - coarse[2]).abs() < 1e-9);
    }

    #[test]
    fn a_load_torque_that_begins_on_a_slope_swings_nothing() {
        let resonance = Resonance::new(0.1, 0.2, None).expect("valid");
        let course = resonance.curvature(&[0.0, 0.01, 0.01, 0.01], &[1.0, 2.0, 3.0, 4.0]);
        assert!(course.iter().all(|x| x.abs() < 1e-9), "{course:?}");
    }

    #[test]
    fn a_hardening_spring_equals_an_independent_integration() {
        let load: Vec<f64> = (0..14).map(|i: i32| f64::from((i - 4).max(0).pow(2) % 7)).collect();
        let mut steps = [0.01; 14];
        steps[0] = 0.0;
        let found = Resonance::new(0.1, 0.2, Some(3.0)).expect("valid").curvature(&steps, &load);
        for (mine, other) in found.iter().zip(HARDENING) {
            assert!((mine - other).abs() < 2e-3 * 16000.0, "{mine} {other}");
        }
    }

    /// SciPy 1.16: `solve_ivp` of the same equation by DOP853 with a tolerance of 1e-12.
    const HARDENING: [f64; 14] = [
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        3265.7615541059317,
        11164.217396139173,
        -4941.721393250378,
        -12018.566418381586,
        -1189.0686690973448,
        -6269.800816833472,
        -1938.7060879490855,
        6237.748382059328,
        16589.743823689812,
    ];

    #[test]
    fn a_spring_that_hardens_far_beyond_the_load_is_linear() {
        let load: Vec<f64> = (0..40).map(|i: i32| f64::from(i * i % 7)).collect();
        let mut steps = [0.01; 40];
        steps[0] = 0.0;
        let linear = Resonance::new(0.1, 0.2, None).expect("valid").curvature(&steps, &load);
        let far = Resonance::new(0.1, 0.2, Some(1e6)).expect("valid").curvature(&steps, &load);
        assert!(linear.iter().zip(far).all(|(one, other)| (one - other).abs() < 1e-6));
    }

    #[test]
    fn a_hardening_spring_begins_at_rest_under_a_constant_load() {
        let held = Resonance::new(0.1, 0.2, Some(1.0)).expect("valid");
        let course = held.curvature(&[0.0, 0.01, 0.01], &[5.0; 3]);
        assert!(course.iter().all(|x| x.abs() < 1e-6), "{course:?}");
    }

    #[test]
    fn refuses_what_does_not_oscillate() {
        for torque in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Resonance::new(1.0, 0.1, Some(torque)).is_none());
        }

        for (period, damping) in [(0.0, 0.1), (-1.0, 0.1), (1.0, 0.0), (1.0, 1.0), (f64::NAN, 0.1)]
        {
            assert!(Resonance::new(period, damping, None).is_none());
        }
    }
}

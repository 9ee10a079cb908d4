//! Zero-phase low-pass filter of a recorded channel: forwards, then backwards.

use std::vec::Vec;

use crate::math::f64::{sin_cos, sqrt};

/// A Butterworth low-pass of fourth order: two sections of second order, by the bilinear transform
/// with the cut-off kept where it is.
///
/// Source: Oppenheim and Schafer 2010, *Discrete-Time Signal Processing*, section 7.2.
///
/// ```
/// # use stribeck::identify::LowPass;
/// let low_pass = LowPass::new(0.1).expect("below the Nyquist frequency");
/// let mut step = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0];
/// low_pass.zero_phase(&mut step, 3);
/// assert!((step[4] + step[5] - 1.0).abs() < 1e-2);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LowPass {
    sections: [Section; 2],
}

/// `(b + 2 b z^-1 + b z^-2) / (1 + a1 z^-1 + a2 z^-2)`, of unit gain at rest.
#[derive(Clone, Copy, Debug)]
struct Section {
    b: f64,
    a1: f64,
    a2: f64,
}

impl Section {
    /// The section with this pole angle: `turn` is the tangent of half the cut-off's phase.
    fn new(turn: f64, damping: f64) -> Self {
        let scale = 1.0 / (1.0 + damping * turn + turn * turn);
        Self {
            b: turn * turn * scale,
            a1: 2.0 * (turn * turn - 1.0) * scale,
            a2: (1.0 - damping * turn + turn * turn) * scale,
        }
    }

    /// Filters `values` from the state that a constant `first` has led to.
    fn run(self, values: impl Iterator<Item = f64>, first: f64, mut write: impl FnMut(f64)) {
        let Self { b, a1, a2 } = self;
        let mut one = (1.0 - b) * first;
        let mut two = (b - a2) * first;
        for x in values {
            let y = b * x + one;
            one = 2.0 * b * x - a1 * y + two;
            two = b * x - a2 * y;
            write(y);
        }
    }
}

impl LowPass {
    /// The filter with a cut-off at this share of the sampling rate; None unless it is above zero
    /// and below one half.
    #[must_use]
    pub fn new(cutoff: f64) -> Option<Self> {
        if !(cutoff > 0.0 && cutoff < 0.5) {
            return None;
        }
        let (sine, cosine) = sin_cos(core::f64::consts::PI * cutoff);
        let turn = sine / cosine;
        // Poles at pi/8 and 3 pi/8 from the imaginary axis: twice their sines.
        let damping = [sqrt(2.0 - sqrt(2.0)), sqrt(2.0 + sqrt(2.0))];
        Some(Self { sections: damping.map(|damping| Section::new(turn, damping)) })
    }

    /// Filters `values` in place, forwards and backwards: no phase, the gain squared.
    ///
    /// The values are continued by `padding` samples at either end, turned about the last one; at
    /// most as many as there are.
    pub fn zero_phase(&self, values: &mut [f64], padding: usize) {
        let [first, .., last] = *values else { return };
        let padding = padding.min(values.len() - 1);
        let before = values[1..=padding].iter().rev().map(|x| 2.0 * first - x);
        let after = values[values.len() - 1 - padding..values.len() - 1].iter().rev();
        let mut padded: Vec<f64> =
            before.chain(values.iter().copied()).chain(after.map(|x| 2.0 * last - x)).collect();
        for _ in 0..2 {
            for section in self.sections {
                let start = padded[0];
                let mut filtered = Vec::with_capacity(padded.len());
                section.run(padded.iter().copied(), start, |y| filtered.push(y));
                padded = filtered;
            }
            padded.reverse();
        }
        let length = values.len();
        values.copy_from_slice(&padded[padding..padding + length]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy 1.16: `sosfiltfilt(butter(4, 0.2, fs=1, output="sos"), x, padlen=5)`.
    #[test]
    fn equals_an_independent_implementation() {
        let mut values: Vec<f64> = (0..12).map(|i| f64::from(i * i % 7)).collect();
        LowPass::new(0.2).expect("valid").zero_phase(&mut values, 5);
        for (mine, other) in values.iter().zip(SCIPY) {
            assert!((mine - other).abs() < 1e-12, "{mine} {other}");
        }
    }

    const SCIPY: [f64; 12] = [
        -0.10531197215799304,
        1.5452712508080335,
        2.670830159486576,
        3.089463678670535,
        2.872629984416434,
        2.1270548883640883,
        1.240645773201142,
        0.9324518287974704,
        1.5264203529631684,
        2.392999767210994,
        2.619055488213377,
        2.1093166393932545,
    ];

    #[test]
    fn leaves_a_constant_as_it_is_and_removes_what_is_fast() {
        let low_pass = LowPass::new(0.1).expect("valid");
        let mut constant = [3.0; 50];
        low_pass.zero_phase(&mut constant, 15);
        assert!(constant.iter().all(|y| (y - 3.0).abs() < 1e-10));
        let mut fast: Vec<f64> = (0..80).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        low_pass.zero_phase(&mut fast, 15);
        assert!(fast[30..50].iter().all(|y| y.abs() < 1e-3));
    }

    #[test]
    fn takes_any_length_and_refuses_a_cutoff_beyond_the_nyquist_frequency() {
        let low_pass = LowPass::new(0.1).expect("valid");
        let (mut none, mut one, mut two) = ([], [4.0], [1.0, 2.0]);
        low_pass.zero_phase(&mut none, 15);
        low_pass.zero_phase(&mut one, 15);
        low_pass.zero_phase(&mut two, 15);
        assert_eq!(one, [4.0]);
        assert!(two.iter().all(|y| y.is_finite()));
        for cutoff in [0.0, -0.1, 0.5, f64::NAN] {
            assert!(LowPass::new(cutoff).is_none());
        }
    }
}

//! Delay of a series, within each segment.

use std::vec::Vec;

use super::columns::Rows;

/// Adds `S(g) - g` to `out`, where `S(g)(t) = g(t - delay)` by linear interpolation, constant
/// beyond the ends of a segment. `series` and `out` have `width` numbers per sample. Returns the
/// derivative of the first number with respect to the delay.
pub fn shift(rows: &Rows, delay: f64, series: &[f64], width: usize, out: &mut [f64]) -> Vec<f64> {
    let count = rows.count();
    let mut by_delay = Vec::with_capacity(count);
    let (steps, starts) = (rows.steps(), rows.starts());
    let ends = starts.iter().skip(1).map(|&(row, _)| row).chain([count]);
    for (&(start, _), end) in starts.iter().zip(ends) {
        let range = start * width..end * width;
        let segment = Segment { steps: &steps[start..end], series: &series[range.clone()], width };
        segment.shift(delay, &mut out[range], &mut by_delay);
    }
    by_delay
}

struct Segment<'a> {
    steps: &'a [f64],
    series: &'a [f64],
    width: usize,
}

impl Segment<'_> {
    fn shift(&self, delay: f64, out: &mut [f64], by_delay: &mut Vec<f64>) {
        let last = self.steps.len() - 1;
        // Times relative to samples k and i: only differences matter, so rounding does not
        // accumulate.
        let mut k = 0;
        let mut ahead = -delay;
        for i in 0..=last {
            if i > 0 {
                ahead += self.steps[i];
            }
            while k < last && ahead >= self.steps[k + 1] {
                k += 1;
                ahead -= self.steps[k];
            }
            // `ahead` is now t_i - delay - t_k.
            let inside = ahead > 0.0 && k < last;
            let weight = if inside { ahead / self.steps[k + 1] } else { 0.0 };
            let (here, next) = (self.row(k), self.row((k + 1).min(last)));
            let out = &mut out[i * self.width..(i + 1) * self.width];
            for (((out, x), here), next) in out.iter_mut().zip(self.row(i)).zip(here).zip(next) {
                *out += here + weight * (next - here) - x;
            }
            by_delay.push(if inside {
                -self.slope(k)
            } else if ahead == 0.0 {
                // At a sample the interpolation has a kink: the mean of both slopes.
                -0.5 * (self.slope(k.wrapping_sub(1)) + self.slope(k))
            } else {
                0.0
            });
        }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.series[row * self.width..(row + 1) * self.width]
    }

    /// Slope between a sample and the next; 0 beyond the ends.
    fn slope(&self, row: usize) -> f64 {
        match self.steps.get(row.wrapping_add(1)) {
            Some(&dt) if row < self.steps.len() => (self.row(row + 1)[0] - self.row(row)[0]) / dt,
            _ => 0.0,
        }
    }
}

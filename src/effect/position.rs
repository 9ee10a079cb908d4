//! Dry friction that varies along the stroke.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that varies along the stroke.
    Position {
        /// Dry friction along the first shape over the stroke.
        position_1: "p1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the second shape over the stroke.
        position_2: "p2" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the third shape over the stroke.
        position_3: "p3" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the fourth shape over the stroke.
        position_4: "p4" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the fifth shape over the stroke.
        position_5: "p5" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the sixth shape over the stroke.
        position_6: "p6" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the seventh shape over the stroke.
        position_7: "p7" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Dry friction along the eighth shape over the stroke.
        position_8: "p8" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
    }
}

impl<S: Real> FrictionEffect<S> for Position<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "position",
        group: "friction",
        title: "Position",
        what: "Preload, wear or alignment differ along the stroke, so dry friction varies with \
               position.",
        formula: "D + sum_j pj b_j(q); b_j = cos(j pi (q - start)/length), or over a period cos, \
                  sin, cos 2, sin 2 ... of 2 pi (q - start)/length",
        needs: "repeated passes in both directions",
        beyond: None,
        channels: &[Channel::Position],
        constants: &["position_start", "position_length", "position_periodic"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let p = [
            &self.position_1,
            &self.position_2,
            &self.position_3,
            &self.position_4,
            &self.position_5,
            &self.position_6,
            &self.position_7,
            &self.position_8,
        ];
        let stroke = (sample.position - constants.position_start) / constants.position_length;
        let half_turn = S::Plain::from_f64(core::f64::consts::PI) * stroke;
        let mut basis = [S::Plain::zero(); 8];
        if constants.position_periodic.is_zero() {
            // cos((j + 1) th) = 2 cos th cos(j th) - cos((j - 1) th)
            let cos = half_turn.cos();
            let (mut before, mut now) = (S::Plain::one(), cos);
            for shape in &mut basis {
                *shape = now;
                (before, now) = (now, (cos + cos) * now - before);
            }
        } else {
            let (sin, cos) = (half_turn + half_turn).sin_cos();
            let (mut c, mut s) = (cos, sin);
            for pair in basis.chunks_exact_mut(2) {
                pair.copy_from_slice(&[c, s]);
                (c, s) = (c * cos - s * sin, s * cos + c * sin);
            }
        }
        split.coulomb.add_linear_combination(p, basis);
    }
}

//! A spring torque of position.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// A torque of position alone that gravity does not explain. It has zero mean over the stroke:
    /// a mean is an offset.
    Spring {
        /// Part proportional to position: torque at the end of the stroke.
        spring_linear: "k1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Quadratic part: torque at the end of the stroke.
        spring_quadratic: "k2" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Cubic part: torque at the end of the stroke.
        spring_cubic: "k3" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
    }
}

impl<S: Real> FrictionEffect<S> for Spring<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "spring",
        group: "rigid body",
        title: "Spring",
        what: "A cable pack, a hose or a balancer exerts a torque that depends only on \
               position and is not gravity.",
        formula: "tf + k1 u + k2 (3 u^2 - 1)/2 + k3 (5 u^3 - 3 u)/2, \
                  u = 2 (q - start)/length - 1",
        needs: "a range of position, passed in both directions",
        beyond: Some("offset"),
        channels: &[Channel::Position],
        constants: &["position_start", "position_length"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let number = S::Plain::from_f64;
        let stroke = (sample.position - constants.position_start) / constants.position_length;
        let u = stroke + stroke - S::Plain::one();
        let square = u * u;
        // Legendre polynomials: zero mean over the stroke, and orthogonal.
        let legendre =
            [u, number(1.5) * square - number(0.5), (number(2.5) * square - number(1.5)) * u];
        let torques = [&self.spring_linear, &self.spring_quadratic, &self.spring_cubic];
        split.additive.add_linear_combination(torques, legendre);
    }
}

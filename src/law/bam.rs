//! Extended friction models of servo actuators (BAM): friction depends on the torque at both ends
//! of the gearbox, `te` that the environment exerts on the joint and `tm` that the motor exerts.
//!
//! The formulas take both as given. Where the motor torque is to be predicted, it follows from the
//! balance `tm = tl + tf(te, tm, v)`, which `batch` solves.

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

const SOURCE: &str = "Duclusaud et al. 2024, BAM";
const CHANNELS: &[Channel] = &[Channel::MotorTorque, Channel::ExternalTorque];

parameters! {
    /// M1: Coulomb and viscous friction.
    BamM1 {
        /// Dry friction, independent of speed and load.
        coulomb_friction: "Kc" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Torque per speed.
        viscous_friction: "Kv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

parameters! {
    /// M2: M1 with a Stribeck curve.
    BamM2 {
        /// Dry friction in full sliding.
        coulomb_friction: "Kc" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Height of the Stribeck curve above Coulomb friction at rest.
        stribeck_height: "Ks" ["T"] 0.0 .. 10.0, start 0.1, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 1.0, None, Nonlinear;
        /// Torque per speed.
        viscous_friction: "Kv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

parameters! {
    /// M3: M1 with dry friction that grows with the torque across the gearbox.
    BamM3 {
        /// Dry friction without load.
        coulomb_friction: "Kc" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Dry friction per torque across the gearbox.
        load_coulomb: "Kl" ["1"] 0.0 .. 0.95, start 0.1, None, Dry;
        /// Torque per speed.
        viscous_friction: "Kv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

parameters! {
    /// M4: M3 with a Stribeck curve for both parts of dry friction.
    BamM4 {
        /// Dry friction in full sliding without load.
        coulomb_friction: "Kc" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Height of the Stribeck curve at rest without load.
        stribeck_height: "Ks" ["T"] 0.0 .. 10.0, start 0.1, Torque, Dry;
        /// Dry friction per torque across the gearbox, in full sliding.
        load_coulomb: "Kl" ["1"] 0.0 .. 0.55, start 0.1, None, Dry;
        /// Height of the Stribeck curve per torque across the gearbox.
        load_stribeck: "Kls" ["1"] 0.0 .. 0.4, start 0.05, None, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 1.0, None, Nonlinear;
        /// Torque per speed.
        viscous_friction: "Kv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

parameters! {
    /// M5: M4 with separate coefficients for each end of the gearbox, so that driving and
    /// back-driving differ.
    BamM5 {
        /// Dry friction in full sliding without load.
        coulomb_friction: "Kc" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Height of the Stribeck curve at rest without load.
        stribeck_height: "Ks" ["T"] 0.0 .. 10.0, start 0.1, Torque, Dry;
        /// Dry friction per external torque, in full sliding.
        external_coulomb: "Ke" ["1"] 0.0 .. 0.95, start 0.1, None, Nonlinear;
        /// Dry friction per motor torque, in full sliding.
        motor_coulomb: "Km" ["1"] 0.0 .. 0.55, start 0.1, None, Nonlinear;
        /// Height of the Stribeck curve per external torque.
        external_stribeck: "Kes" ["1"] 0.0 .. 0.95, start 0.05, None, Nonlinear;
        /// Height of the Stribeck curve per motor torque.
        motor_stribeck: "Kms" ["1"] 0.0 .. 0.4, start 0.05, None, Nonlinear;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 1.0, None, Nonlinear;
        /// Torque per speed.
        viscous_friction: "Kv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

parameters! {
    /// M6: M5 with a quadratic part while the torques at the two ends of the gearbox oppose each
    /// other.
    BamM6 {
        /// Dry friction in full sliding without load.
        coulomb_friction: "Kc" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Height of the Stribeck curve at rest without load.
        stribeck_height: "Ks" ["T"] 0.0 .. 10.0, start 0.1, Torque, Dry;
        /// Dry friction per external torque, in full sliding.
        external_coulomb: "Ke" ["1"] 0.0 .. 0.95, start 0.1, None, Nonlinear;
        /// Dry friction per motor torque, in full sliding.
        motor_coulomb: "Km" ["1"] 0.0 .. 0.55, start 0.1, None, Nonlinear;
        /// Height of the Stribeck curve per external torque.
        external_stribeck: "Kes" ["1"] 0.0 .. 0.95, start 0.05, None, Nonlinear;
        /// Height of the Stribeck curve per motor torque.
        motor_stribeck: "Kms" ["1"] 0.0 .. 0.4, start 0.05, None, Nonlinear;
        /// Stribeck height per square of the external torque while the motor drives.
        external_quadratic: "Kqe" ["1/T"] 0.0 .. 2.0, start 0.02, InverseTorque, Dry;
        /// Stribeck height per square of the motor torque while the joint is back-driven.
        motor_quadratic: "Kqm" ["1/T"] 0.0 .. 2.0, start 0.02, InverseTorque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 1.0, None, Nonlinear;
        /// Torque per speed.
        viscous_friction: "Kv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for BamM1<S> {
    const INFO: LawInfo = LawInfo {
        id: "bam_m1",
        title: "Servo M1: Coulomb and viscous",
        source: SOURCE,
        formula: "Kc sgn v + Kv v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

impl<S: Real> FrictionLaw<S> for BamM2<S> {
    const INFO: LawInfo = LawInfo {
        id: "bam_m2",
        title: "Servo M2: Stribeck",
        source: SOURCE,
        formula: "(Kc + E Ks) sgn v + Kv v, E = exp(-|v/vs|^alpha)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape: stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

impl<S: Real> FrictionLaw<S> for BamM3<S> {
    const INFO: LawInfo = LawInfo {
        id: "bam_m3",
        title: "Servo M3: load",
        source: SOURCE,
        formula: "(Kc + Kl |te - tm|) sgn v + Kv v",
        parameters: Self::TABLE,
        channels: CHANNELS,
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "load"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            load: self.load_coulomb.scale(torque_across(sample)),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

impl<S: Real> FrictionLaw<S> for BamM4<S> {
    const INFO: LawInfo = LawInfo {
        id: "bam_m4",
        title: "Servo M4: load and Stribeck",
        source: SOURCE,
        formula: "(Kc + E Ks + (Kl + E Kls) |te - tm|) sgn v + Kv v, E = exp(-|v/vs|^alpha)",
        parameters: Self::TABLE,
        channels: CHANNELS,
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "load"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let shape = stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent);
        let share = self.load_coulomb + shape.value * self.load_stribeck;
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape,
            load: share.scale(torque_across(sample)),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

impl<S: Real> FrictionLaw<S> for BamM5<S> {
    const INFO: LawInfo = LawInfo {
        id: "bam_m5",
        title: "Servo M5: directional load",
        source: SOURCE,
        formula: "(Kc + E Ks + |Ke te - Km tm| + E |Kes te - Kms tm|) sgn v + Kv v, \
                  E = exp(-|v/vs|^alpha)",
        parameters: Self::TABLE,
        channels: CHANNELS,
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "load", "quadrant"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let shape = stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent);
        let sliding = weighted(self.external_coulomb, self.motor_coulomb, sample);
        let sticking = weighted(self.external_stribeck, self.motor_stribeck, sample);
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape,
            load: sliding + shape.value * sticking,
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

impl<S: Real> FrictionLaw<S> for BamM6<S> {
    const INFO: LawInfo = LawInfo {
        id: "bam_m6",
        title: "Servo M6: quadratic load",
        source: SOURCE,
        formula: "(Kc + E Ks + |Ke te - Km tm| + E (|Kes te - Kms tm| + Q)) sgn v + Kv v, \
                  E = exp(-|v/vs|^alpha); where te tm < 0: Q = Kqe te^2 for |te| < |tm|, \
                  Kqm tm^2 for |te| > |tm|; else 0",
        parameters: Self::TABLE,
        channels: CHANNELS,
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "load", "quadrant"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let shape = stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent);
        let sliding = weighted(self.external_coulomb, self.motor_coulomb, sample);
        let sticking = weighted(self.external_stribeck, self.motor_stribeck, sample);
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape,
            load: sliding + shape.value * (sticking + self.quadratic(sample)),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

impl<S: Real> BamM6<S> {
    /// The smaller of two opposing torques, squared and weighted; 0 if they are equal.
    #[inline]
    fn quadratic(&self, sample: &Sample<S::Plain>) -> S {
        let (external, motor) = (sample.external_torque, sample.motor_torque);
        let by_external = self.external_quadratic.scale(external * external);
        let by_motor = self.motor_quadratic.scale(motor * motor);
        let excess = external.abs() - motor.abs();
        let smaller = S::choose(excess.is_positive(), by_motor, S::zero());
        let smaller = S::choose(excess.is_negative(), by_external, smaller);
        S::choose((external.sign() * motor.sign()).is_negative(), smaller, S::zero())
    }
}

/// Torque across the gearbox `|te - tm|` (T).
#[inline]
fn torque_across<P: Real>(sample: &Sample<P>) -> P {
    (sample.external_torque - sample.motor_torque).abs()
}

/// `|ke te - km tm|` (T).
#[inline]
fn weighted<S: Real>(external: S, motor: S, sample: &Sample<S::Plain>) -> S {
    (external.scale(sample.external_torque) - motor.scale(sample.motor_torque)).abs()
}

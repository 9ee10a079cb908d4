//! Desired motions: strokes back and forth, and Fourier series.

use crate::scalar::Scalar;

/// Largest number of harmonics of a Fourier series.
pub const HARMONICS: usize = 8;

/// The desired motion at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference<P> {
    /// Position (X).
    pub position: P,
    /// Velocity (X/s).
    pub velocity: P,
    /// Acceleration (X/s2).
    pub acceleration: P,
}

impl<P: Scalar + PartialOrd> Reference<P> {
    fn resting(position: P) -> Self {
        Self { position, velocity: P::zero(), acceleration: P::zero() }
    }
}

/// A desired motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trajectory<P> {
    /// Back and forth, with rest at both ends.
    Stroke(Stroke<P>),
    /// A periodic motion.
    Fourier(Fourier<P>),
}

impl<P: Scalar + PartialOrd> Trajectory<P> {
    /// The desired motion at `time` (s).
    #[must_use]
    pub fn at(&self, time: P) -> Reference<P> {
        match self {
            Self::Stroke(stroke) => stroke.at(time),
            Self::Fourier(series) => series.at(time),
        }
    }
}

/// Moves from one point to another and back, with a dwell before each move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke<P> {
    /// Initial position (X).
    pub from: P,
    /// Turning point (X).
    pub to: P,
    /// Velocity profile of a move.
    pub profile: Profile<P>,
    /// Dwell before each move (s).
    pub dwell: P,
}

/// The velocity profile of a move from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile<P> {
    /// Constant acceleration, constant speed, constant deceleration.
    Trapezoid {
        /// Largest speed (X/s).
        speed: P,
        /// Acceleration (X/s2).
        acceleration: P,
    },
    /// A polynomial of fifth degree with zero acceleration at both ends.
    Quintic {
        /// Duration of a move (s).
        duration: P,
    },
}

impl<P: Scalar + PartialOrd> Profile<P> {
    /// Duration of a move over `distance > 0` and of its acceleration phase (s).
    fn times(&self, distance: P) -> (P, P) {
        match *self {
            Self::Quintic { duration } => (duration, duration),
            Self::Trapezoid { speed, acceleration } => {
                let (full, short) = (speed / acceleration, (distance / acceleration).sqrt());
                let ramp = if full < short { full } else { short };
                (ramp + distance / (acceleration * ramp), ramp)
            }
        }
    }

    /// Distance, speed and acceleration of a move over `distance`, `time` (s) after its start.
    fn along(&self, distance: P, time: P) -> Reference<P> {
        let (duration, ramp) = self.times(distance);
        if distance.is_zero() || time <= P::zero() {
            return Reference::resting(P::zero());
        }
        if time >= duration {
            return Reference::resting(distance);
        }
        match *self {
            Self::Quintic { duration } => quintic(distance, duration, time / duration),
            Self::Trapezoid { acceleration, .. } => {
                trapezoid(distance, duration, acceleration, ramp, time)
            }
        }
    }
}

fn quintic<P: Scalar + PartialOrd>(distance: P, duration: P, x: P) -> Reference<P> {
    let number = P::from_f64;
    let left = P::one() - x;
    let speed = distance / duration;
    Reference {
        position: distance * x * x * x * (number(10.0) + x * (number(6.0) * x - number(15.0))),
        velocity: speed * number(30.0) * x * x * left * left,
        acceleration: speed / duration * number(60.0) * x * left * (left - x),
    }
}

fn trapezoid<P: Scalar + PartialOrd>(
    distance: P,
    duration: P,
    acceleration: P,
    ramp: P,
    time: P,
) -> Reference<P> {
    let half = P::from_f64(0.5);
    let (left, top) = (duration - time, acceleration * ramp);
    if time < ramp {
        let velocity = acceleration * time;
        Reference { position: half * velocity * time, velocity, acceleration }
    } else if left < ramp {
        let velocity = acceleration * left;
        Reference {
            position: distance - half * velocity * left,
            velocity,
            acceleration: -acceleration,
        }
    } else {
        let position = top * (time - half * ramp);
        Reference { position, velocity: top, acceleration: P::zero() }
    }
}

impl<P: Scalar + PartialOrd> Stroke<P> {
    /// Duration of a move, including the dwell before it (s).
    #[must_use]
    pub fn duration(&self) -> P {
        self.dwell + self.profile.times((self.to - self.from).abs()).0
    }

    fn at(&self, time: P) -> Reference<P> {
        let duration = self.duration();
        let count = integer_part(time / duration);
        let begun = time - P::from_f64(count) * duration - self.dwell;
        let way = self.to - self.from;
        let back = integer_part(P::from_f64(0.5 * count)) * 2.0 < count;
        let (start, way) = if back { (self.to, -way) } else { (self.from, way) };
        let direction = way.sign();
        let along = self.profile.along(way.abs(), begun);
        Reference {
            position: start + direction * along.position,
            velocity: direction * along.velocity,
            acceleration: direction * along.acceleration,
        }
    }
}

/// The integer part of `x >= 0`.
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]
fn integer_part<P: Scalar + PartialOrd>(x: P) -> f64 {
    x.value() as i64 as f64
}

/// `centre + sum_k sine_k sin(k w t) + cosine_k cos(k w t)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fourier<P> {
    /// Mean position (X).
    pub centre: P,
    /// Angular frequency of the first harmonic (rad/s).
    pub frequency: P,
    /// Sine coefficient of each harmonic (X).
    pub sine: [P; HARMONICS],
    /// Cosine coefficient of each harmonic (X).
    pub cosine: [P; HARMONICS],
}

impl<P: Scalar + PartialOrd> Fourier<P> {
    fn at(&self, time: P) -> Reference<P> {
        let mut sum = Reference::resting(self.centre);
        let mut frequency = P::zero();
        for (&sine, &cosine) in self.sine.iter().zip(&self.cosine) {
            frequency += self.frequency;
            let (s, c) = (frequency * time).sin_cos();
            let swing = sine * s + cosine * c;
            sum.position += swing;
            sum.velocity += frequency * (sine * c - cosine * s);
            sum.acceleration += -(frequency * frequency * swing);
        }
        sum
    }
}

//! The elastoplastic model, stepped for a velocity that is constant over the step.
//!
//! `dz/dt = v (1 - a s0 z sgn v/D)`, `tf = s0 z + s1 dz/dt + V + additive` (Dupont et al. 2002, eqs
//! 8-14). In units of the deflection in full sliding, `x = s0 z sgn v/D`, a bristle is elastic
//! (`a = 0`) up to `b`, slides (`a = 1`) from 1 on, and between them `a = cos^2(pi p/2)` with
//! `1 - x = (1 - b) p`. The elastic and the sliding part are exact. In the transition `ln p` falls
//! at a rate between 1 and `1 + 1.14/(1 - b)` along the travel `s0 |v| t/D`; sixteen Runge-Kutta
//! steps of fourth order in that variable are stable for every travel and have an error below
//! `6e-6 D/s0` for `b <= 0.99`.

use super::{BristleState, Interval, Step, following};
use crate::sample::Split;
use crate::scalar::{Mask, Real};

/// Runge-Kutta steps of fourth order in the transition, and for a travel below [`SHORT`].
const STEPS: (u8, u8) = (16, 4);

/// A travel below this share of the width of the transition needs fewer steps: error below `1e-6`.
const SHORT: f64 = 0.5;

/// Above this travel in units of `D/s0` dry friction is negligible.
const VANISHED: f64 = 1e30;

/// Below this `p` sliding is exponential to rounding.
const SLIDING: f64 = 1e-8;

/// Nodes and weights of the Gauss-Legendre rule with twelve points on -1 .. 1, the upper half.
const GAUSS: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_5, 0.203_167_426_723_065_92),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_23),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_43),
    (0.981_560_634_246_719_3, 0.047_175_336_386_511_83),
];

/// Parameters of an elastoplastic bristle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElastoplasticBristle<S> {
    /// Stiffness `s0` (T/X).
    pub stiffness: S,
    /// Damping `s1` (T s/X).
    pub damping: S,
    /// Share `b` of the deflection in full sliding up to which the bristle is elastic.
    pub breakaway: S,
}

impl<S: Real> ElastoplasticBristle<S> {
    /// Steps over `interval` with the dry magnitude `dry` constant; the torque is that of `split`,
    /// at the end.
    #[inline]
    pub fn step_over(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let before = state.z;
        let glide = self.advance(state, dry, interval);
        if interval.mean_velocity.is_some() {
            let moved = (split.dry() - dry) / self.stiffness;
            state.z += moved.along(interval.velocity()) * glide.following;
        }
        let velocity = interval.sample.velocity;
        let rate = self.slope(state.z, split.dry(), velocity).scale(velocity);
        let torque = self.stiffness * state.z + self.damping * rate + split.rate + split.additive;
        if !interval.mean {
            return Step::same(torque);
        }
        let mut mean_torque = self.stiffness * glide.mean + split.rate + split.additive;
        let slip = || (state.z - before).scale(S::Plain::one() / interval.dt);
        mean_torque += self.damping * interval.dt.is_positive().either(slip, S::zero);
        Step { torque, mean_torque }
    }

    /// `b`, at most 1: no bristle is elastic beyond full sliding.
    #[inline]
    fn breakaway(&self) -> S {
        S::choose(self.breakaway.is_below(S::Plain::one()), self.breakaway, S::one())
    }

    /// `dz/dt` over `v`.
    #[inline]
    fn slope(&self, z: S, dry: S, velocity: S::Plain) -> S {
        let vanished = self.stiffness.reaches(dry.plain() * S::Plain::from_f64(VANISHED));
        let slides = || {
            let x = (self.stiffness * z / dry).along(velocity);
            slope_at(x, self.breakaway())
        };
        vanished.either(S::zero, slides)
    }

    #[inline]
    fn advance(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        interval: &Interval<S::Plain>,
    ) -> Glide<S> {
        let before = state.z;
        let travel = interval.travel();
        let direction = interval.velocity().sign();
        let pull = self.stiffness.scale(travel);
        let unit = (dry / self.stiffness).scale(direction);
        let slides = || {
            let (whole, x) = (pull / dry, before / unit);
            let room = self.breakaway() - x;
            let rises = || {
                let rise = S::from_plain(travel * direction);
                [before + rise, before + rise.scale(S::Plain::from_f64(0.5)), S::zero()]
            };
            room.reaches(whole.plain())
                .either(rises, || self.yields(unit, whole, x, room, interval.mean))
        };
        let vanished = pull.reaches(dry.plain() * S::Plain::from_f64(VANISHED));
        let [z, mean, following] = travel.at_zero().either(
            || [before, before, S::zero()],
            || vanished.either(|| [unit, unit, S::one()], slides),
        );
        state.z = z;
        Glide { mean, following }
    }

    /// Deflection at the end, its mean and the share of a change of the target that it has
    /// followed, over the travel `whole` from `x`, in units of the deflection in full sliding,
    /// beyond the elastic `room`.
    #[inline]
    fn yields(&self, unit: S, whole: S, x: S, room: S, area: bool) -> [S; 3] {
        let one = S::Plain::one();
        let start = (-x).shift(one);
        // First the elastic part, then the remaining travel; areas are those under 1 - x.
        let elastic = || {
            let way = start + -room;
            [whole + -room, way, room * (start + -room.scale(S::Plain::from_f64(0.5)))]
        };
        let [left, way, before] = room.is_positive().either(elastic, || [whole, start, S::zero()]);
        let breadth = (-self.breakaway()).shift(one);
        let slides = || [left, way * left * (-left).phi(1)];
        let bound = breadth.plain() * S::Plain::from_f64(SLIDING);
        let [fall, under] =
            way.is_above(bound).either(|| transition(way / breadth, breadth, left, area), slides);
        let end = unit * (-(way * (-fall).exp())).shift(one);
        let mean = unit * (-((before + under) / whole)).shift(one);
        [end, mean, following(-fall, (-fall).phi(1))]
    }
}

/// `dz/dt` over `v` at `x = s0 z sgn v/D`.
#[inline]
pub(super) fn slope_at<S: Real>(x: S, breakaway: S) -> S {
    let one = S::Plain::one();
    let slides = || {
        let way = (-x).shift(one);
        let breadth = (-breakaway).shift(one);
        let beyond = way.is_negative().or(way.at_zero());
        beyond.either(|| way, || way * descent(way / breadth, breadth))
    };
    x.is_below(breakaway.plain()).either(S::one, slides)
}

/// The result of a step: the mean deflection, and the share of a change of the target that it has
/// followed.
struct Glide<S> {
    mean: S,
    following: S,
}

/// The rate at which `ln p` falls along the travel: `sin^2(pi p/2)/((1 - b) p) + cos^2(pi p/2)`.
#[inline]
fn descent<S: Real>(p: S, breadth: S) -> S {
    let falls = || {
        let (sin, cos) = p.scale(S::Plain::from_f64(core::f64::consts::FRAC_PI_2)).sin_cos();
        sin * (sin / (breadth * p)) + cos * cos
    };
    // In single precision this bound is 0.
    let arrived = p.is_below(S::Plain::from_f64(1e-150)).or(p.at_zero());
    arrived.either(S::one, falls)
}

/// The decrease of `ln p` over a travel from `p`, and the area under `1 - x` if `area` is set.
#[inline]
fn transition<S: Real>(p: S, breadth: S, travel: S, area: bool) -> [S; 2] {
    let long = travel.is_above(breadth.plain() * S::Plain::from_f64(SHORT));
    let fall =
        long.either(|| fall(p, breadth, travel, STEPS.0), || fall(p, breadth, travel, STEPS.1));
    let under = if area { area_between(p, p * (-fall).exp(), breadth) } else { S::zero() };
    [fall, under]
}

/// The decrease of `ln p` over a travel from `p`, with `steps` Runge-Kutta steps.
#[inline]
fn fall<S: Real>(p: S, breadth: S, travel: S, steps: u8) -> S {
    let (half, sixth) = (S::Plain::from_f64(0.5), S::Plain::from_f64(1.0 / 6.0));
    let step = travel.scale(S::Plain::from_f64(1.0 / f64::from(steps)));
    let rate = |fall: S| descent(p * (-fall).exp(), breadth);
    let mut fall = S::zero();
    for _ in 0..steps {
        let a = rate(fall);
        let b = rate(fall + (step * a).scale(half));
        let c = rate(fall + (step * b).scale(half));
        let d = rate(fall + step * c);
        fall += (step * (a + b + b + c + c + d)).scale(sixth);
    }
    fall
}

/// `(1 - b) int dp/h` from `end` to `start`, integrated over the square root of `p`, in which it is
/// smooth.
#[inline]
fn area_between<S: Real>(start: S, end: S, breadth: S) -> S {
    let (half, two) = (S::Plain::from_f64(0.5), S::Plain::from_f64(2.0));
    let (high, low) = (start.sqrt(), end.sqrt());
    let (centre, reach) = ((high + low).scale(half), (high - low).scale(half));
    let mut sum = S::zero();
    for (node, weight) in GAUSS {
        for node in [node, -node] {
            let root = centre + reach.scale(S::Plain::from_f64(node));
            let density = root.scale(two) / descent(root * root, breadth);
            sum.add_scaled(&density, S::Plain::from_f64(weight));
        }
    }
    breadth * reach * sum
}

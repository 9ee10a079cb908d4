//! The Leuven model with a Maxwell slip hysteresis, stepped exactly for a velocity that is constant
//! over the step.
//!
//! `dz/dt = v (1 - F sgn v/D)`, `tf = F + s1 dz/dt + V + additive`, where `F` is the sum of
//! elements that follow `z`, `dF_i = k_i dz` while `|F_i| <= W_i` (Lampaert, Swevers and Al-Bender
//! 2002, with `n = 1`). Along the travel `z` moves in one direction and `F` relaxes to `D`, faster
//! while more elements stick; each element reaches its limit at most once, so a step has a bounded
//! number of pieces.

use super::{Elements, Interval, MAX_ELEMENTS, SATURATED, Step, following, logarithm_ratio};
use crate::sample::Split;
use crate::scalar::{Choice, Mask, Real};

/// Relative distance at which an element counts as having reached its limit.
const ROUNDING: f64 = 1e-12;

/// Above this ratio of force per travel to dry friction, dry friction is negligible.
const VANISHED: f64 = 1e30;

/// Parameters of the elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeuvenBristle<'a, S> {
    /// Largest force of each element, relative to the others (T).
    pub friction: &'a [S; MAX_ELEMENTS],
    /// Stiffness of each element (T/X).
    pub stiffness: &'a [S; MAX_ELEMENTS],
    /// Number of elements.
    pub count: usize,
    /// Damping `s1` (T s/X).
    pub damping: S,
}

impl<S: Real> LeuvenBristle<'_, S> {
    /// Steps over `interval` with the dry magnitude `dry` constant; the torque is that of `split`,
    /// at the end.
    #[inline]
    pub fn step_over(
        &self,
        state: &mut Elements<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let direction = interval.velocity().sign();
        let travel = interval.travel();
        let (limit, end) = (self.limit(split), split.dry());
        let glide = self.advance(state, limit, dry, direction, travel);
        if interval.mean_velocity.is_some() {
            let change = (end - dry) * glide.following;
            let toward = S::Plain::choose(change.is_positive(), direction, -direction);
            let free = self.free(state, limit, toward);
            let way = change.scale(toward * direction) / free.stiffness;
            let way = S::choose(way.is_below(free.room.plain()), way, free.room);
            state.force =
                free.any.either(|| self.shifted(state, limit, toward, way), || state.force);
        }
        let velocity = interval.sample.velocity;
        let force = self.total(state);
        let rate = slope(force.along(velocity), end).scale(velocity);
        let torque = force + self.damping * rate + split.rate + split.additive;
        if !interval.mean {
            return Step::same(torque);
        }
        let slides = || {
            let mean = glide.area.scale(S::Plain::one() / travel);
            let mean_rate = slope(mean, dry).scale(interval.velocity());
            mean.scale(direction) + self.damping * mean_rate + split.rate + split.additive
        };
        Step { torque, mean_torque: travel.at_zero().either(|| torque, slides) }
    }

    #[inline]
    fn total(&self, state: &Elements<S>) -> S {
        state.force[..self.count()].iter().fold(S::zero(), |sum, &force| sum + force)
    }

    #[inline]
    fn count(&self) -> usize {
        self.count.min(MAX_ELEMENTS)
    }

    /// The largest force of an element over its friction: the sum of all is the holding torque, so
    /// that `F` can always reach `D`.
    #[inline]
    fn limit(&self, split: &Split<S>) -> S {
        let total = self.friction[..self.count()].iter().fold(S::zero(), |sum, &part| sum + part);
        (split.coulomb + split.height + split.load + split.smoothed_amplitude) / total
    }

    /// Advances along `direction`, piece by piece between the limits of the elements.
    #[inline]
    fn advance(
        &self,
        state: &mut Elements<S>,
        limit: S,
        dry: S,
        direction: S::Plain,
        travel: S::Plain,
    ) -> Glide<S> {
        let dry = S::choose(dry.is_positive(), dry, S::zero());
        let mut glide = Glide {
            force: state.force,
            left: S::from_plain(travel),
            area: S::zero(),
            following: S::zero(),
        };
        for _ in 0..=self.count() {
            let goes_on = glide.left.is_positive();
            glide = goes_on.either(|| self.piece(&glide, state, limit, dry, direction), || glide);
            state.force = glide.force;
        }
        glide
    }

    /// Advances by the next piece.
    #[inline]
    fn piece(
        &self,
        glide: &Glide<S>,
        state: &Elements<S>,
        limit: S,
        dry: S,
        direction: S::Plain,
    ) -> Glide<S> {
        let left = glide.left;
        let force = self.total(state).scale(direction);
        let gap = dry - force;
        let toward = S::Plain::choose(gap.is_positive(), direction, -direction);
        let along = toward * direction;
        let free = self.free(state, limit, toward);
        let slides = || Glide { left: S::zero(), area: glide.area + force * left, ..*glide };
        let moves = || {
            let piece = Piece { dry, gap, stiffness: free.stiffness };
            let reach = piece.travel_to(free.room);
            let comes_to_limit = || {
                let shifted = self.shifted(state, limit, toward, free.room);
                Glide {
                    force: self.stopped(shifted, limit, toward),
                    left: left + -reach,
                    area: glide.area + dry * (reach - free.room.scale(along)),
                    following: glide.following,
                }
            };
            let ends = || {
                let [way, following] = piece.step_over(left);
                Glide {
                    force: self.shifted(state, limit, toward, way.scale(along)),
                    left: S::zero(),
                    area: glide.area + dry * (left - way),
                    following,
                }
            };
            reach.is_below(left.plain()).either(comes_to_limit, ends)
        };
        let settled = if gap.is_zero() { S::Mask::of(true) } else { free.any.not() };
        settled.either(slides, moves)
    }

    /// The elements that a motion of `z` along `toward` loads.
    #[inline]
    fn free(&self, state: &Elements<S>, limit: S, toward: S::Plain) -> Free<S> {
        let infinite = S::from_f64(f64::INFINITY);
        let mut free = Free { any: S::Mask::of(false), stiffness: S::zero(), room: infinite };
        for k in 0..self.count() {
            let room = self.friction[k] * limit - state.force[k].scale(toward);
            let is_free = room.is_positive();
            let joins = || {
                let room = room / self.stiffness[k];
                let nearest = S::choose(room.is_below(free.room.plain()), room, free.room);
                [free.stiffness + self.stiffness[k], nearest]
            };
            let [stiffness, nearest] = is_free.either(joins, || [free.stiffness, free.room]);
            free = Free { any: free.any.or(is_free), stiffness, room: nearest };
        }
        free
    }

    /// Forces after `z` has moved by `way` along `toward`, at most to the limit of the first
    /// element.
    #[inline]
    fn shifted(
        &self,
        state: &Elements<S>,
        limit: S,
        toward: S::Plain,
        way: S,
    ) -> [S; MAX_ELEMENTS] {
        let mut forces = state.force;
        for (k, force) in forces[..self.count()].iter_mut().enumerate() {
            let before = *force;
            let room = self.friction[k] * limit - before.scale(toward);
            let moves = || before + (self.stiffness[k] * way).scale(toward);
            *force = room.is_positive().either(moves, || before);
        }
        forces
    }

    /// Sets elements that are at their limit up to rounding exactly to it.
    #[inline]
    fn stopped(
        &self,
        mut forces: [S; MAX_ELEMENTS],
        limit: S,
        toward: S::Plain,
    ) -> [S; MAX_ELEMENTS] {
        for (k, force) in forces[..self.count()].iter_mut().enumerate() {
            let most = self.friction[k] * limit;
            let room = most - force.scale(toward);
            let bound = most.plain() * S::Plain::from_f64(ROUNDING);
            *force = S::choose(room.abs().is_above(bound), *force, most.scale(toward));
        }
        forces
    }
}

/// A travel in progress: forces, the remaining travel, the area under the force, and the share of a
/// change of the target that the force has followed.
#[derive(Clone, Copy)]
struct Glide<S> {
    force: [S; MAX_ELEMENTS],
    left: S,
    area: S,
    following: S,
}

impl<S: Real> Choice<S::Mask> for Glide<S> {
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        Self {
            force: Choice::select(mask, yes.force, no.force),
            left: S::choose(mask, yes.left, no.left),
            area: S::choose(mask, yes.area, no.area),
            following: S::choose(mask, yes.following, no.following),
        }
    }
}

/// Elements that are not at their limit: whether there are any, the sum of their stiffness, and the
/// least distance to a limit.
struct Free<S: Real> {
    any: S::Mask,
    stiffness: S,
    room: S,
}

/// A part of the travel in which the same elements stick: `F` relaxes to `D`.
struct Piece<S> {
    dry: S,
    gap: S,
    stiffness: S,
}

impl<S: Real> Piece<S> {
    /// The travel after which `z` has moved by `room`, infinite if it never does: the sum of all
    /// limits is at least `D`, so that the last element never reaches its limit, whatever the
    /// rounding.
    #[inline]
    fn travel_to(&self, room: S) -> S {
        let size = self.gap.abs();
        let share = self.stiffness * room / size;
        share.is_below(S::Plain::from_f64(1.0 - ROUNDING)).either(
            || room * (self.dry / size) * logarithm_ratio(-share),
            || S::from_f64(f64::INFINITY),
        )
    }

    /// The motion of `z` over a travel, and the share of a change of the target that the force has
    /// followed.
    #[inline]
    fn step_over(&self, travel: S) -> [S; 2] {
        let pull = self.stiffness * travel;
        let follows = || {
            let y = -(pull / self.dry);
            let phi = y.phi(1);
            [-(self.gap * y * phi) / self.stiffness, following(y, phi)]
        };
        let bound = self.dry.plain() * S::Plain::from_f64(SATURATED);
        pull.reaches(bound).either(|| [self.gap / self.stiffness, S::one()], follows)
    }
}

/// `dz/dt` over `v`, for a force along the velocity; 0 where dry friction is negligible.
#[inline]
fn slope<S: Real>(force: S, dry: S) -> S {
    let vanished = force.abs().reaches(dry.plain() * S::Plain::from_f64(VANISHED));
    vanished.either(S::zero, || (-(force / dry)).shift(S::Plain::one()))
}

//! The Leuven model with a Maxwell slip hysteresis, stepped exactly for a velocity held over the
//! step.
//!
//! `dz/dt = v (1 - F sgn v/D)`, `tf = F + s1 dz/dt + V + additive`, where `F` is the sum of elements
//! that follow `z`, `dF_i = k_i dz` while `|F_i| <= W_i` (Lampaert, Swevers and Al-Bender 2002, with
//! `n = 1`). Along the travel `z` moves one way and `F` relaxes to `D`, faster while more elements
//! stick; each element reaches its limit at most once, so that a step has a bounded number of pieces.

use super::{Elements, Interval, MOST_ELEMENTS, SATURATED, Step, following, logarithm_ratio};
use crate::sample::Split;
use crate::scalar::{Real, Scalar};

/// An element so near its limit, relative to it, has reached it.
const ROUNDING: f64 = 1e-12;

/// Above this ratio of a force per travel to dry friction, dry friction has vanished.
const VANISHED: f64 = 1e30;

/// Parameters of the elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeuvenBristle<'a, S> {
    /// What each element carries at most, relative to the others (T).
    pub friction: &'a [S; MOST_ELEMENTS],
    /// Stiffness of each element (T/X).
    pub stiffness: &'a [S; MOST_ELEMENTS],
    /// How many elements there are.
    pub count: usize,
    /// Damping `s1` (T s/X).
    pub damping: S,
}

impl<S: Scalar> LeuvenBristle<'_, S> {
    /// Steps over `interval` with the dry magnitude `dry` held; `split` is that of the sample, with
    /// which the torque is read.
    #[inline]
    pub fn over(
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
            let toward = if change.value() > 0.0 { direction } else { -direction };
            if let Some(free) = self.free(state, limit, toward) {
                let way = change.scale(toward * direction) / free.stiffness;
                let way = if way.value() < free.room.value() { way } else { free.room };
                self.shift(state, limit, toward, way);
            }
        }
        let velocity = interval.sample.velocity;
        let force = self.total(state);
        let rate = slope(force.scale(velocity.sign()), end).scale(velocity);
        let torque = force + self.damping * rate + split.rate + split.additive;
        if !interval.mean || travel.value() == 0.0 {
            return Step::same(torque);
        }
        let mean = glide.area.scale(S::Plain::one() / travel);
        let mean_rate = slope(mean, dry).scale(interval.velocity());
        let mean = mean.scale(direction) + self.damping * mean_rate;
        Step { torque, mean_torque: mean + split.rate + split.additive }
    }

    #[inline]
    fn total(&self, state: &Elements<S>) -> S {
        state.force[..self.count()].iter().fold(S::zero(), |sum, &force| sum + force)
    }

    #[inline]
    fn count(&self) -> usize {
        self.count.min(MOST_ELEMENTS)
    }

    /// What an element carries at most, over its friction: together they carry what holds the joint
    /// at rest, so that `F` can always reach `D`.
    #[inline]
    fn limit(&self, split: &Split<S>) -> S {
        let total = self.friction[..self.count()].iter().fold(S::zero(), |sum, &part| sum + part);
        (split.coulomb + split.height + split.load + split.smoothed_amplitude) / total
    }

    /// Travels along `direction`, piece by piece between the elements' limits.
    #[inline]
    fn advance(
        &self,
        state: &mut Elements<S>,
        limit: S,
        dry: S,
        direction: S::Plain,
        travel: S::Plain,
    ) -> Glide<S> {
        let dry = if dry.value() > 0.0 { dry } else { S::zero() };
        let mut left = S::from_plain(travel);
        let mut glide = Glide { area: S::zero(), following: S::zero() };
        for _ in 0..=self.count() {
            let force = self.total(state).scale(direction);
            let gap = dry - force;
            let toward = if gap.value() > 0.0 { direction } else { -direction };
            let free = self.free(state, limit, toward).filter(|_| !gap.is_zero());
            let Some(free) = free.filter(|_| left.value() > 0.0) else {
                glide.area += force * left;
                break;
            };
            let piece = Piece { dry, gap, stiffness: free.stiffness };
            match piece.travel_to(free.room).filter(|reach| reach.value() < left.value()) {
                Some(reach) => {
                    self.shift(state, limit, toward, free.room);
                    self.stop(state, limit, toward);
                    glide.area += dry * (reach - free.room.scale(toward * direction));
                    left += -reach;
                }
                None => {
                    let (way, following) = piece.over(left);
                    self.shift(state, limit, toward, way.scale(toward * direction));
                    glide.area += dry * (left - way);
                    glide.following = following;
                    break;
                }
            }
        }
        glide
    }

    /// The elements that a motion of `z` along `toward` loads, if there are any.
    #[inline]
    fn free(&self, state: &Elements<S>, limit: S, toward: S::Plain) -> Option<Free<S>> {
        let mut free: Option<Free<S>> = None;
        for k in 0..self.count() {
            let room = self.friction[k] * limit - state.force[k].scale(toward);
            if room.value() > 0.0 {
                let (stiffness, room) = (self.stiffness[k], room / self.stiffness[k]);
                free = Some(match free {
                    Some(others) => Free {
                        stiffness: others.stiffness + stiffness,
                        room: if room.value() < others.room.value() { room } else { others.room },
                    },
                    None => Free { stiffness, room },
                });
            }
        }
        free
    }

    /// Moves `z` by `way` along `toward`, no further than the first element's limit.
    #[inline]
    fn shift(&self, state: &mut Elements<S>, limit: S, toward: S::Plain, way: S) {
        for (k, force) in state.force[..self.count()].iter_mut().enumerate() {
            let room = self.friction[k] * limit - force.scale(toward);
            if room.value() > 0.0 {
                *force += (self.stiffness[k] * way).scale(toward);
            }
        }
    }

    /// Puts elements that have come to their limit, but for rounding, exactly there.
    #[inline]
    fn stop(&self, state: &mut Elements<S>, limit: S, toward: S::Plain) {
        for (k, force) in state.force[..self.count()].iter_mut().enumerate() {
            let most = self.friction[k] * limit;
            let room = most - force.scale(toward);
            if room.value().abs() <= ROUNDING * most.value() {
                *force = most.scale(toward);
            }
        }
    }
}

/// What moves over a travel: the area under the force, and how far the force has followed where it
/// tends to.
struct Glide<S> {
    area: S,
    following: S,
}

/// Elements that are not at their limit: their stiffness together, and how far the first is from it.
struct Free<S> {
    stiffness: S,
    room: S,
}

/// A stretch over which the same elements stick: `F` relaxes to `D`.
struct Piece<S> {
    dry: S,
    gap: S,
    stiffness: S,
}

impl<S: Scalar> Piece<S> {
    /// The travel after which `z` has moved by `room`, if it ever does: together the elements carry
    /// `D` at least, so that the last one never comes to its limit, whatever the rounding.
    #[inline]
    fn travel_to(&self, room: S) -> Option<S> {
        let size = self.gap.abs();
        let share = self.stiffness * room / size;
        (share.value() < 1.0 - ROUNDING).then(|| room * (self.dry / size) * logarithm_ratio(-share))
    }

    /// How far `z` moves over a travel, and how far the force has followed where it tends to.
    #[inline]
    fn over(&self, travel: S) -> (S, S) {
        let pull = self.stiffness * travel;
        if pull.value() >= SATURATED * self.dry.value() {
            return (self.gap / self.stiffness, S::one());
        }
        let y = -(pull / self.dry);
        let phi = y.phi(1);
        (-(self.gap * y * phi) / self.stiffness, following(y, phi))
    }
}

/// `dz/dt` over `v`, for a force along the velocity; 0 where dry friction has vanished.
#[inline]
fn slope<S: Scalar>(force: S, dry: S) -> S {
    if force.value().abs() >= VANISHED * dry.value() {
        return S::zero();
    }
    (-(force / dry)).shift(S::Plain::one())
}

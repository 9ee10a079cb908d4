use std::cmp::Ordering;
use std::vec::Vec;

use proptest::prelude::*;

use super::Enclosure;
use crate::Real;
use crate::common::random::{cases, spread};
use crate::math::f64 as elementary;

/// An interval within `[-scale, scale]` and a number in it.
fn pair(scale: f64) -> impl Strategy<Value = (Enclosure, f64)> {
    (-scale..scale, -scale..scale, 0.0..=1.0).prop_map(|(a, b, share): (f64, f64, f64)| {
        let whole = Enclosure::new(a.min(b), a.max(b));
        let inside = whole.lower + share * (whole.upper - whole.lower);
        (whole, inside.clamp(whole.lower, whole.upper))
    })
}

/// `m 2^e`, exactly.
#[derive(Clone, Copy, Debug)]
struct Exact {
    m: i128,
    e: i32,
}

impl Exact {
    fn of(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        let fraction = i128::from(bits & ((1 << 52) - 1));
        let m = if exponent == 0 { fraction } else { fraction | 1 << 52 };
        let sign = if x < 0.0 { -1 } else { 1 };
        Self { m: sign * m, e: exponent.max(1) - 1075 }
    }

    fn times(self, other: Self) -> Self {
        Self { m: self.m * other.m, e: self.e + other.e }
    }

    /// Its sum with a number whose digits do not lie too far apart for 127 bits.
    fn plus(self, other: Self) -> Option<Self> {
        let e = self.e.min(other.e);
        let shifted = |x: Self| {
            let by = u32::try_from(x.e - e).ok()?;
            (by < x.m.unsigned_abs().leading_zeros().saturating_sub(2)).then(|| x.m << by)
        };
        Some(Self { m: shifted(self)? + shifted(other)?, e })
    }

    fn compare(self, other: Self) -> Ordering {
        let size = |x: Self| 128 - x.m.unsigned_abs().leading_zeros() as i32 + x.e;
        match (self.m.signum(), other.m.signum()) {
            (a, b) if a != b || a == 0 => a.cmp(&b),
            (sign, _) => {
                let order = size(self).cmp(&size(other)).then_with(|| {
                    let e = self.e.min(other.e);
                    let a = self.m.unsigned_abs() << (self.e - e);
                    a.cmp(&(other.m.unsigned_abs() << (other.e - e)))
                });
                if sign > 0 { order } else { order.reverse() }
            }
        }
    }

    fn is_within(self, bounds: Enclosure) -> bool {
        let above = bounds.lower == f64::NEG_INFINITY
            || self.compare(Self::of(bounds.lower)) != Ordering::Less;
        let below = bounds.upper == f64::INFINITY
            || self.compare(Self::of(bounds.upper)) != Ordering::Greater;
        above && below
    }
}

/// Numbers of every size, with few and many digits, next to others and below the normal range.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        spread(-30, 30),
        spread(-540, -500),
        spread(500, 511),
        (0_u64..1 << 53).prop_map(f64::from_bits),
        (-1000_i32..1000).prop_map(f64::from),
        (-3_i64..3).prop_map(|k| f64::from_bits((1.0_f64.to_bits() as i64 + k) as u64)),
    ]
}

proptest! {
    #![proptest_config(cases(30_000))]

    #[test]
    fn intervals_contain_the_values_at_points((x, a) in pair(4.0), (y, b) in pair(3.0)) {
        let pairs = [
            (x + y, a + b),
            (x * y, a * b),
            (x / y, a / b),
            (x.exp(), Real::exp(a)),
            (x.expm1(), Real::expm1(a)),
            (x.phi(1), Real::phi(a, 1)),
            (x.phi(2), Real::phi(a, 2)),
            (x.tanh(), Real::tanh(a)),
            (x.atan(), Real::atan(a)),
            (x.cbrt(), Real::cbrt(a)),
            (x.sin(), Real::sin(a)),
            (x.cos(), Real::cos(a)),
            (x.abs(), a.abs()),
            (x.abs().sqrt(), Real::sqrt(a.abs())),
            (x.abs().powf(y), Real::powf(a.abs(), b)),
            (x.square(), a * a),
            (x.choose_below(y, x, y), a.min(b)),
        ];
        for (k, (whole, at)) in pairs.into_iter().enumerate() {
            prop_assert!(whole.lower <= at && at <= whole.upper, "{k}: {whole:?} {at}");
        }
    }

    /// Cancellation, underflow and ties, in exact integers.
    #[test]
    fn arithmetic_contains_the_exact_value(a in number(), b in number()) {
        let (x, y) = (Enclosure::point(a), Enclosure::point(b));
        let (exact_a, exact_b) = (Exact::of(a), Exact::of(b));
        if let Some(sum) = exact_a.plus(exact_b) {
            prop_assert!(sum.is_within(x + y), "{a:e} + {b:e}: {:?}", x + y);
        }
        prop_assert!(exact_a.times(exact_b).is_within(x * y), "{a:e} * {b:e}: {:?}", x * y);
        if b != 0.0 {
            // q is a bound of a/b if q b is one of a, on the side that the sign of b says.
            let quotient = x / y;
            let of = |q: f64| Exact::of(q).times(exact_b).compare(exact_a);
            let (low, high) = if b > 0.0 { (Ordering::Less, Ordering::Greater) }
                else { (Ordering::Greater, Ordering::Less) };
            prop_assert!(quotient.lower.is_infinite() || of(quotient.lower) != high, "{a:e}/{b:e}");
            prop_assert!(quotient.upper.is_infinite() || of(quotient.upper) != low, "{a:e}/{b:e}");
        }
        let root = Enclosure::point(a.abs()).sqrt();
        let square = |q: f64| Exact::of(q).times(Exact::of(q)).compare(Exact::of(a.abs()));
        prop_assert!(square(root.lower) != Ordering::Greater, "{a:e}");
        prop_assert!(square(root.upper) != Ordering::Less, "{a:e}");
    }

    /// Nothing that a law can compute has a NaN in a bound, which a comparison would ignore.
    #[test]
    fn bounds_are_never_nan_and_never_reversed(
        picks in proptest::array::uniform4(0_usize..12),
        operations in proptest::collection::vec((0_usize..17, 0_usize..12, 0_usize..12), 1..6),
    ) {
        let (inf, big) = (f64::INFINITY, f64::MAX);
        let ends = [-inf, -big, -1.0, -f64::MIN_POSITIVE, -0.0, 0.0, f64::from_bits(1), 0.5, 1.0, 710.0,
            big, inf];
        let interval = |a: usize, b: usize| {
            let (a, b) = (ends[a].min(ends[b]), ends[a].max(ends[b]));
            Enclosure::new(a, b)
        };
        let mut x = interval(picks[0], picks[1]);
        for (operation, a, b) in operations {
            let y = interval(a, b);
            x = match operation {
                0 => x + y,
                1 => x - y,
                2 => x * y,
                3 => x / y,
                4 => x.exp(),
                5 => x.expm1(),
                6 => x.ln(),
                7 => x.powf(y),
                8 => y.powf(x),
                9 => x.sqrt(),
                10 => x.cbrt(),
                11 => x.sin(),
                12 => x.cos(),
                13 => x.tanh(),
                14 => x.atan(),
                15 => x.phi(1),
                _ => x.sign() * x.abs(),
            };
            prop_assert!(x.lower <= x.upper, "{operation} {y:?}: {x:?}");
        }
    }
}

#[test]
fn nan_is_all_numbers() {
    for x in [Enclosure::point(f64::NAN), Enclosure::new(f64::NAN, f64::NAN)] {
        assert_eq!(x, Enclosure::ALL);
        assert_eq!((x * Enclosure::point(-1.0)).lower, f64::NEG_INFINITY);
    }
}

/// An interval across a bound takes both alternatives: where the middle alone decided, the ratio of
/// acceleration to speed of `indri_b` counted as 1e15 over all speeds from 1e-30 on.
#[test]
fn an_interval_across_a_bound_has_both_alternatives() {
    let (x, most) = (Enclosure::new(0.1, 1e30), Enclosure::point(1e15));
    let capped = x.choose_below(most, x, most);
    assert!(capped.lower <= 0.1 && capped.upper >= 1e15);
    assert_eq!(Enclosure::new(0.1, 0.2).choose_below(most, x, most), x);
    assert_eq!(most.choose_below(most, x, most), most);
}

/// The values at 50 digits, as in `tests/math.rs`, also below the normal range.
#[test]
fn functions_contain_the_value_at_50_digits() {
    let mut checked = 0;
    for row in include_str!("../../../tests/elementary/references.csv").lines() {
        let fields: Vec<_> = row.split(',').collect();
        let ["f64", function, arguments, nearest, above] = fields[..] else { continue };
        let number =
            |bits: &str| f64::from_bits(u64::from_str_radix(bits, 16).expect("hexadecimal bits"));
        let mut arguments = arguments.split(' ').map(number);
        let x = Enclosure::point(arguments.next().expect("an argument"));
        let found = match function {
            "exp" => x.exp(),
            "expm1" => x.expm1(),
            "phi_1" => x.phi(1),
            "phi_2" => x.phi(2),
            "phi_3" => x.phi(3),
            "ln" => x.ln(),
            "tanh" => x.tanh(),
            "atan" => x.atan(),
            "sin" => x.sin(),
            "cos" => x.cos(),
            "powf" => x.powf(Enclosure::point(arguments.next().expect("an exponent"))),
            _ => panic!("no function {function}"),
        };
        // The value lies between its nearest number and the next one in the direction of `above`.
        let (nearest, above): (f64, f64) = (number(nearest), above.parse().expect("a number"));
        let outwards = (above > 0.0) == (nearest > 0.0);
        let next = match above {
            0.0 => nearest,
            _ if outwards => nearest.next_up(),
            _ => nearest.next_down(),
        };
        let (low, high) = (nearest.min(next), nearest.max(next));
        let contained = found.lower <= low && high <= found.upper;
        assert!(contained, "{function} {x:?}: {found:?} {nearest:e}");
        checked += 1;
    }
    assert!(checked > 1000, "{checked}");
}

/// Sines of intervals across a maximum, and beside one, after many turns.
#[test]
fn extrema_between_the_ends_are_found() {
    let quarter = core::f64::consts::FRAC_PI_2;
    for turn in [0_i32, 1, -3, 1000, 1 << 20, 1 << 30] {
        let crest = f64::from(turn) * core::f64::consts::TAU + quarter;
        for width in [1e-9 * crest.abs().max(1.0), 0.4] {
            let across = Enclosure::new(crest - width, crest + width).sin();
            assert_eq!(across.upper, 1.0, "{turn} {width}");
            let beside = Enclosure::new(crest + width, crest + 1.2).sin();
            assert!(beside.upper >= elementary::sin(crest + width));
        }
    }
}

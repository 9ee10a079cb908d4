//! A prototype: `exp`, `ln`, `powf` and `tanh` with explicit fused multiply-add, beside those of the
//! crate, which have none. Times in turns, and errors against values at 50 digits.
//!
//! ```console
//! cargo bench --bench fused
//! ```
//!
//! It shares the constants and polynomials of `src/math/`. `docs/performance.md` holds the figures
//! and what follows from them.
// The prototype is what `clippy.toml` refuses elsewhere.
#![allow(clippy::disallowed_methods)]
#![allow(missing_docs)]

#[allow(dead_code)]
#[path = "../src/math/bits.rs"]
mod bits;
#[path = "../src/math/double.rs"]
mod double;
#[allow(dead_code)]
#[path = "../src/math/format.rs"]
mod format;
#[path = "../src/math/single.rs"]
mod single;

/// Estrin's scheme as in `src/math/polynomial.rs`, each product fused with the sum that follows.
mod polynomial {
    macro_rules! estrin {
        ($x:ident; [$first:expr], $($coefficient:expr),+ $(,)?) => {
            estrin!(@pairs $x [$first] $($coefficient),+)
        };
        ($x:ident; $($coefficient:expr),+ $(,)?) => {
            estrin!(@pairs $x [] $($coefficient),+)
        };
        (@pairs $x:ident [] $last:expr) => { $last };
        (@pairs $x:ident [$($joined:expr),*] $even:expr, $odd:expr $(, $rest:expr)*) => {
            estrin!(@pairs $x [$($joined,)* $crate::Fused::fused($odd, $x, $even)] $($rest),*)
        };
        (@pairs $x:ident [$only:expr]) => { $only };
        (@pairs $x:ident [$($joined:expr),+] $last:expr) => {
            estrin!(@pairs $x [$($joined,)+ $last])
        };
        (@pairs $x:ident [$($joined:expr),+]) => {{
            let square = $x * $x;
            estrin!(@pairs square [] $($joined),+)
        }};
    }

    macro_rules! polynomials {
        ($(
            $name:ident = $constant:ident($x:ident $(, $([$without_next:ident])? $($first:ident)?)?):
            $($coefficient:expr),+ $(,)?;
        )+) => {$(
            const $constant: &'static [Self] = &[$($coefficient),+];

            #[inline(always)]
            fn $name($($($without_next: Self,)? $($first: Self,)?)? $x: Self) -> Self {
                estrin!($x; $($([$without_next],)? $($first,)?)? $($coefficient),+)
            }
        )+};
    }

    pub(crate) use {estrin, polynomials};
}

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::Instant;

use format::{Format, within};

/// Numbers per block, as in the crate; calls per measurement; measurements.
const BLOCK: usize = 256;
const CALLS: usize = 24;
const REPEATS: usize = 400;
/// The exponent of the powers.
const EXPONENT: f32 = 1.375;

/// A format with the fused operation.
trait Fused: Format {
    /// `2 / (3 ln 2)`, rounded, and the rest.
    const SCALE: [Self; 2];
    /// `self * factor + add`, rounded once.
    fn fused(self, factor: Self, add: Self) -> Self;
    /// The integer nearest to `self * factor`, as in `Bits::nearest`.
    fn nearest_product(self, factor: Self) -> (Self, Self::Integer);
}

macro_rules! fused {
    ($float:ident, $scale:expr) => {
        impl Fused for $float {
            const SCALE: [Self; 2] = $scale;

            #[inline(always)]
            fn fused(self, factor: Self, add: Self) -> Self {
                self.mul_add(factor, add)
            }

            #[inline(always)]
            fn nearest_product(self, factor: Self) -> (Self, Self::Integer) {
                const ROUNDER: $float = 1.5 / $float::EPSILON;
                let rounded = self.mul_add(factor, ROUNDER);
                (rounded - ROUNDER, rounded.to_bits())
            }
        }
    };
}

fused!(f64, [0.9617966939259756, 5.0577616648125907e-17]);
fused!(f32, [0.9617967, -7.028462e-9]);

#[inline(always)]
fn exp<F: Fused>(x: F) -> F {
    let (lowest, highest) = F::EXP_RANGE;
    let x = within(x, lowest, highest);
    let (n, bits) = x.nearest_product(F::LOG2_E);
    let large = n.fused(-F::LN_2[0], x);
    let r = n.fused(-F::LN_2[1], large);
    let beyond = F::exp_beyond(-(n * F::LN_2[1]), r);
    (F::of(1.0) + (large + beyond)).times_power_of_two(bits)
}

#[inline(always)]
fn ln<F: Fused>(x: F) -> F {
    let (k, m) = x.exponent_and_significand();
    let f = m - F::of(1.0);
    let s = f / (m + F::of(1.0));
    let half_square = F::of(0.5) * f * f;
    let small = s.fused(F::log_beyond(half_square, s * s), k * F::LN_2[1]);
    let value = k.fused(F::LN_2[0], f - (half_square - small));
    let value = if x == F::of(0.0) { -F::INFINITY } else { value };
    let value = if x < F::of(0.0) { F::NAN } else { value };
    if x < F::INFINITY { value } else { x }
}

/// The binary logarithm in two parts: products are split exactly by the fused operation instead of
/// by halves of a significand.
#[inline(always)]
fn log2<F: Fused>((k, m): (F, F)) -> (F, F) {
    let (one, three) = (F::of(1.0), F::of(3.0));
    let (numerator, denominator) = (m - one, m + one);
    let denominator_low = m - (denominator - one);
    let reciprocal = one / denominator;
    let s = numerator * reciprocal;
    let residual = (-s).fused(denominator_low, (-s).fused(denominator, numerator));
    let s_low = residual * reciprocal;

    let z = s * s;
    let z_low = (s + s).fused(s_low, s.fused(s, -z));
    let high = three + z;
    let low = (z * z).fused(F::log_tail(z), (z - (high - three)) + z_low);

    let product = s * high;
    let product_low = s_low.fused(high, s.fused(low, s.fused(high, -product)));
    let [scale, scale_low] = F::SCALE;
    let log = scale * product;
    let log_low = scale.fused(product_low, scale_low.fused(product, scale.fused(product, -log)));
    let high = k + log;
    (high, ((k - high) + log) + log_low)
}

/// `p l` for `l = high + low`: the rounded product, and the rest.
#[inline(always)]
fn product<F: Fused>(p: F, (high, low): (F, F)) -> (F, F) {
    let product = p * high;
    (product, p.fused(low, p.fused(high, -product)))
}

#[inline(always)]
fn exp2_of_fraction<F: Fused>(fraction: F) -> F {
    fraction.fused(F::exp2_series(fraction), F::of(1.0))
}

#[inline(always)]
fn log2_fast<F: Fused>(x: F) -> (F, F) {
    log2(x.exponent_and_significand_of_normal())
}

/// As `powf_fast` of the crate: NaN in the special cases.
#[inline(always)]
fn powf_fast<F: Fused>(x: F, logarithm: (F, F), p: F) -> F {
    let zero = F::of(0.0);
    let (product, rest) = product(p, logarithm);
    let (n, bits) = (product + rest).nearest();
    let value = exp2_of_fraction((product - n) + rest).times_power_of_two_in_range(bits);
    let in_range = x.is_normal_and_positive() & (product.abs() < F::EXP2_NORMAL);
    let value = if in_range { value } else { F::NAN };
    if (x == zero) & (p > zero) { zero } else { value }
}

/// The power of a positive number, over the whole range.
#[inline(always)]
fn powf<F: Fused>(x: F, p: F) -> F {
    let (product, rest) = product(p, log2(x.exponent_and_significand()));
    let rest = if product.abs() > F::EXP2_RANGE { F::of(0.0) } else { rest };
    let product = within(product, -F::EXP2_RANGE, F::EXP2_RANGE);
    let (n, bits) = (product + rest).nearest();
    exp2_of_fraction((product - n) + rest).times_power_of_two(bits)
}

#[inline(always)]
fn tanh<F: Fused>(x: F) -> F {
    let one = F::of(1.0);
    let size = F::of(2.0) * within(x.abs(), F::of(0.0), F::TANH_ONE);
    let (n, bits) = size.nearest_product(F::LOG2_E);
    let large = n.fused(-F::LN_2[0], size);
    let beyond = F::expm1_beyond(-(n * F::LN_2[1]), n.fused(-F::LN_2[1], large));
    let scale = F::half_power_of_two(bits);
    let constant = scale - F::of(0.5);
    let high = scale.fused(large, constant);
    let low = scale.fused(beyond, scale.fused(large, -(high - constant)));

    let h = high + low;
    let lost = low - (h - high);
    let denominator = one + h;
    let part = denominator - one;
    let denominator_lost = (one - (denominator - part)) + (h - part) + lost;
    let q = h / denominator;
    (q + (-q).fused(denominator_lost, lost) * (one - q)).copysign(x)
}

/// Numbers that fill whole cache lines.
#[derive(Clone)]
#[repr(align(64))]
struct Block<T>([T; BLOCK]);

macro_rules! loops {
    ($name:ident, $float:ident, $simd:ty) => {
        mod $name {
            use super::{BLOCK, Block, EXPONENT, black_box};
            use stribeck::math::$float as own;

            pub type Loop = fn($simd, &mut [$float; BLOCK], &[$float; BLOCK]);

            macro_rules! each {
                ($function:expr) => {
                    |simd, out, x| {
                        simd.vectorize(
                            #[inline(always)]
                            || out.iter_mut().zip(x).for_each(|(out, &x)| *out = $function(x)),
                        );
                    }
                };
            }

            macro_rules! powers {
                ($log2:expr, $powf:expr) => {
                    |simd, out, x| {
                        simd.vectorize(
                            #[inline(always)]
                            || {
                                let p = black_box($float::from(EXPONENT));
                                let mut lows = Block([0.0; BLOCK]);
                                let logarithms = out.iter_mut().zip(&mut lows.0);
                                for ((high, low), &x) in logarithms.zip(x) {
                                    (*high, *low) = $log2(x);
                                }
                                for ((out, &x), &low) in out.iter_mut().zip(x).zip(&lows.0) {
                                    *out = $powf(x, (*out, low), p);
                                }
                            },
                        );
                    }
                };
            }

            /// Name, arguments, the loop of the crate and that of the prototype.
            pub const LOOPS: [(&str, [$float; 2], Loop, Loop); 4] = [
                ("exp", [-20.0, 5.0], each!(own::exp), each!(super::exp)),
                (
                    "powf",
                    [0.01, 9.0],
                    powers!(own::log2_fast, own::powf_fast),
                    powers!(super::log2_fast, super::powf_fast),
                ),
                ("ln", [0.01, 9.0], each!(own::ln), each!(super::ln)),
                ("tanh", [-5.0, 5.0], each!(own::tanh), each!(super::tanh)),
            ];

            /// Prints the least times of both in turns, and of `exp` and `powf` together.
            pub fn compare(simd: $simd, unit: &str) {
                let mut both = [0.0; 2];
                for (name, [low, high], own, fused) in LOOPS {
                    // In an order that branch prediction cannot learn.
                    let share = |k: usize| (k * 7919 % BLOCK) as $float / BLOCK as $float;
                    let x = Block(std::array::from_fn(|k| low + (high - low) * share(k)));
                    let mut out = x.clone();
                    let times = super::least([own, fused].map(|each| {
                        let (x, mut out) = (x.clone(), out.clone());
                        move || each(simd, black_box(&mut out.0), black_box(&x.0))
                    }));
                    fused(simd, &mut out.0, &x.0);
                    if ["exp", "powf"].contains(&name) {
                        both = [both[0] + times[0], both[1] + times[1]];
                    }
                    super::row(stringify!($float), unit, name, times);
                }
                super::row(stringify!($float), unit, "exp and powf", both);
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
loops!(double_v3, f64, pulp::x86::V3);
#[cfg(target_arch = "x86_64")]
loops!(single_v3, f32, pulp::x86::V3);
#[cfg(target_arch = "x86_64")]
loops!(double_v4, f64, pulp::x86::V4);
#[cfg(target_arch = "x86_64")]
loops!(single_v4, f32, pulp::x86::V4);

/// Least nanoseconds per number, measured in turns: load of the computer only adds.
fn least(mut work: [impl FnMut(); 2]) -> [f64; 2] {
    let mut least = [f64::INFINITY; 2];
    for _ in 0..REPEATS {
        for (work, least) in work.iter_mut().zip(&mut least) {
            let begin = Instant::now();
            (0..CALLS).for_each(|_| work());
            *least = least.min(begin.elapsed().as_secs_f64());
        }
    }
    least.map(|seconds| 1e9 * seconds / (CALLS * BLOCK) as f64)
}

fn row(float: &str, unit: &str, name: &str, [own, fused]: [f64; 2]) {
    println!("| {name} | {float}, {unit} | {own:.3} | {fused:.3} | {:.2} |", own / fused);
}

/// The error in units in the last place, from a row of the references.
macro_rules! error {
    ($float:ident, $whole:ident, $function:expr, $arguments:expr, $nearest:expr, $above:expr) => {{
        let number = |bits: &str| {
            $float::from_bits($whole::from_str_radix(bits, 16).expect("hexadecimal bits"))
        };
        let arguments: Vec<$float> = $arguments.split(' ').map(number).collect();
        let value = match ($function, &arguments[..]) {
            ("exp", &[x]) => exp(x),
            ("ln", &[x]) => ln(x),
            ("tanh", &[x]) => tanh(x),
            ("powf", &[x, p]) if x > 0.0 => powf(x, p),
            _ => continue,
        };
        let place = |x: $float| i128::from(x.abs().to_bits());
        ((place(value) - place(number($nearest))) as f64 - $above).abs()
    }};
}

fn print_errors() {
    let mut worst = BTreeMap::<(&str, &str), f64>::new();
    for row in include_str!("../tests/elementary/references.csv").lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [format, function, arguments, nearest, above] = cells[..] else {
            panic!("five cells: {row}");
        };
        let above: f64 = above.parse().expect("a number");
        let error = if format == "f64" {
            error!(f64, u64, function, arguments, nearest, above)
        } else {
            error!(f32, u32, function, arguments, nearest, above)
        };
        let largest = worst.entry((function, format)).or_default();
        *largest = largest.max(error);
    }
    println!("\n| function | format | largest error, units in the last place |\n|---|---|---|");
    for ((function, format), error) in worst {
        println!("| {function} | {format} | {error:.2} |");
    }
}

fn main() {
    println!("| function | numbers | ns | ns, fused | ratio |\n|---|---|---|---|---|");
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(simd) = pulp::x86::V3::try_new() {
            double_v3::compare(simd, "AVX2");
            single_v3::compare(simd, "AVX2");
        }
        if let Some(simd) = pulp::x86::V4::try_new() {
            double_v4::compare(simd, "AVX-512");
            single_v4::compare(simd, "AVX-512");
        }
    }
    print_errors();
}

//! Reduction of an argument of any size to quarter turns (Payne and Hanek).
//!
//! The argument is an integer times a power of two, `m 2^e`. Of `2^e 2/pi` only a window of 192
//! bits matters: higher bits add full turns for every `m`, lower bits are below the precision.

use super::format::Format;

/// 64 zeros, then the binary digits of 2/pi.
const TWO_OVER_PI: [u64; 20] = [
    0x0000_0000_0000_0000,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
];

/// Binary digits of the fraction of a quarter turn in [`quarter_turns`].
const FRACTION: u32 = 126;

/// `n` modulo 4 and `r` in two parts of `|x| = n pi/2 + r`, for finite `|x| >= 1`.
pub fn reduce<F: Format>(x: F) -> (F::Integer, F, F) {
    let (whole, fraction) = quarter_turns(x.integer_and_exponent());
    let (high, low) = F::pair_of_fraction(fraction, FRACTION);
    let [right_angle, right_angle_low] = F::PI_HALF_PAIR;

    let r = high * right_angle;
    let (high_short, angle_short) = (high.high_half(), right_angle.high_half());
    let (high_rest, angle_rest) = (high - high_short, right_angle - angle_short);
    let lost = ((high_short * angle_short - r) + high_short * angle_rest + high_rest * angle_short)
        + high_rest * angle_rest;
    (F::integer(whole), r, lost + (high * right_angle_low + low * right_angle))
}

/// Quarter turns of `m 2^e`: the nearest integer modulo 4, and the remainder in multiples of
/// `2^-126`.
fn quarter_turns((m, e): (u64, i32)) -> (u8, i128) {
    // The first bit of the window is worth two quarter turns.
    let start = usize::try_from(e + 62).unwrap_or(0);
    let word = |i: usize| u128::from(TWO_OVER_PI.get(start / 64 + i).copied().unwrap_or(0));
    let window = |i: usize| (((word(i) << 64 | word(i + 1)) << (start % 64)) >> 64) as u64;
    let product = |i: usize| u128::from(m) * u128::from(window(i));

    let turns = (product(0) << 64).wrapping_add(product(1)).wrapping_add(product(2) >> 64);
    let whole = turns.wrapping_add(1 << (FRACTION - 1)) >> FRACTION;
    ((whole % 4) as u8, turns.wrapping_sub(whole << FRACTION) as i128)
}

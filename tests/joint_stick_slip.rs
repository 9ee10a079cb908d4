//! The stick-slip example of Canudas de Wit et al. 1995.

use stribeck::joint::{self, Joint, Posture, Push};
use stribeck::{Composed, Spec, State};

/// s0, s1, s2, Fc, Fs, vs, alpha.
const LUGRE_1995: [f64; 7] = [1e5, 316.227_766_016_837_95, 0.4, 1.0, 1.5, 1e-3, 2.0];

/// Speed (m/s) at which a mass slips, and below which it sticks again.
const SLIPPING: f64 = 0.01;
const STICKING: f64 = 1e-4;

struct Slip {
    /// Times at which it starts to move and to slip (s).
    moves: f64,
    start: f64,
    peak: f64,
}

/// The slips of 1 kg, pulled by a spring of 2 N/m at 0.1 m/s.
fn slips(friction: &Composed<f64>, dt: f64, seconds: f64) -> Vec<Slip> {
    let pulled = Joint { stiffness: 2.0, ..Joint::free(1.0) };
    let mut posture = Posture { position: 0.0, velocity: 0.0 };
    let mut state = State::default();
    let mut slips: Vec<Slip> = Vec::new();
    let (mut slipping, mut moves) = (false, 0.0);
    for k in 0..(seconds / dt) as u32 {
        let time = f64::from(k) * dt;
        let push = Push { support: 0.1 * time, support_velocity: 0.1, time, ..Push::by_motor(0.0) };
        let mut body = pulled.moving(posture, &push);
        joint::step(friction, &mut state, &mut body, dt);
        if posture.velocity == 0.0 {
            moves = time;
        }
        posture = body.posture;
        if posture.velocity > SLIPPING && !slipping {
            slips.push(Slip { moves, start: time, peak: 0.0 });
        }
        slipping = posture.velocity > if slipping { STICKING } else { SLIPPING };
        if let Some(slip) = slips.last_mut() {
            slip.peak = posture.velocity.max(slip.peak);
        }
    }
    slips
}

#[test]
fn stick_slip_of_the_1995_example() {
    let friction = Spec::new("lugre", []).unwrap().with(&LUGRE_1995).unwrap();
    for dt in [1e-4, 1e-3] {
        let slips = slips(&friction, dt, 27.0);
        assert_eq!(slips.len(), 4);
        assert!((slips[0].start - 7.45).abs() < 0.01, "first slip at {} s", slips[0].start);
        for pair in slips.windows(2) {
            let period = pair[1].start - pair[0].start;
            assert!((period - 6.363).abs() < 0.0015, "period {period} s");
            assert!((pair[0].peak - 0.370).abs() < 0.0005, "peak {} m/s", pair[0].peak);
        }
    }
}

/// The same curve without a bristle sticks until the spring force is 1.5 N, at 7.5 s, and slips a
/// little later and faster: there is no presliding.
#[test]
fn a_static_law_sticks_and_slips_as_well() {
    let [_, _, viscous, coulomb, stiction, velocity, exponent] = LUGRE_1995;
    let values = [coulomb, stiction - coulomb, velocity, exponent, viscous];
    let friction = Spec::new("bittencourt_a", []).unwrap().with(&values).unwrap();
    let slips = slips(&friction, 1e-3, 27.0);
    assert_eq!(slips.len(), 3);
    assert!(slips[0].moves > 7.499 && slips[0].moves < 7.502, "moves at {} s", slips[0].moves);
    for pair in slips.windows(2) {
        let period = pair[1].start - pair[0].start;
        assert!(period > 6.363 && period < 1.03 * 6.363, "period {period} s");
        assert!(pair[0].peak > 0.370 && pair[0].peak < 1.04 * 0.370, "peak {} m/s", pair[0].peak);
    }
}

//! Blocks of samples have the bits of evaluation sample by sample.
#![cfg(feature = "std")]

use crate::common::{every_model, motion, values};
use stribeck::batch::{self, TimeStep};
use stribeck::{Interval, State};

/// More than two blocks, the last one partial.
const ROWS: usize = 300;

#[test]
fn every_model_has_the_bits_of_scalar_evaluation() {
    let motion = motion(ROWS);
    let mut steps = vec![motion.dt; ROWS];
    (steps[0], steps[77], steps[128], steps[200]) = (f64::NAN, 0.0, f64::INFINITY, f64::INFINITY);
    let late: Vec<f64> =
        (0..ROWS).map(|i| 0.5 * (motion.velocity[i] + motion.velocity[i.max(1) - 1])).collect();
    for mean_velocity in [None, Some(&late[..])] {
        let mut columns = motion.columns();
        columns.dt = TimeStep::Each(&steps);
        columns.mean_velocity = mean_velocity;
        for spec in every_model() {
            let needs_balance =
                spec.channels().any(|channel| columns.channels.get(channel).is_none());
            if needs_balance || spec.has("delay") {
                continue;
            }
            let values = values(&spec);
            let model = spec.with(&values).unwrap();
            let mut state = State::default();
            let torque = batch::torque(&spec, &values, &columns).unwrap();
            for (i, &torque) in torque.iter().enumerate() {
                let sample = stribeck::Sample::of(|channel| {
                    columns.channels.get(channel).map_or(0.0, |column| column[i])
                });
                let settled = steps[i] == f64::INFINITY;
                if settled {
                    state = model.settled(&sample);
                } else if steps[i].is_nan() || steps[i] == 0.0 {
                    state = State::default();
                }
                let dt = if settled || steps[i].is_nan() { 0.0 } else { steps[i] };
                let mean_velocity = mean_velocity.map(|mean| mean[i]);
                let interval = Interval { sample, mean_velocity, dt, mean: false };
                let alone = model.step_over(&mut state, &interval).torque;
                assert_eq!(torque, alone, "{spec}: row {i}");
            }
        }
    }
}

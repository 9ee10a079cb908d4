//! The torque of a model and its derivatives as a graph that runs over whole columns.

use core::ops::Range;
use std::borrow::Cow;
use std::cell::RefCell;
use std::rc::Rc;
use std::thread_local;
use std::vec;
use std::vec::Vec;

use super::Outputs;
use super::columns::{Columns, Rows};
use crate::composed::Spec;
use crate::dynamics::Interval;
use crate::graph::{
    self, Beginning, Inputs, Numbers, Operation, Recorded, Recorder, Schedule, Start,
};
use crate::scalar::Real;
use crate::table::Channel;

/// Columns after the channels: the mean velocity over each sample's step, and its length (which is
/// a parameter if it is the same for all samples).
const MEAN_VELOCITY: usize = Channel::ALL.len();
const STEP: usize = MEAN_VELOCITY + 1;

/// Number of compiled models that are kept: a fit alternates between few.
const KEPT: usize = 16;

/// The compiled torque of a model and its derivatives with respect to some parameters.
pub(super) struct Compiled {
    schedule: Schedule,
}

/// What a model is compiled for; the key of the cache.
#[derive(Clone, PartialEq)]
struct Purpose {
    spec: Spec,
    wanted: Vec<usize>,
    mean_velocity: bool,
    uniform_step: bool,
    /// Whether a segment starts with a settled state.
    settles: bool,
}

thread_local! {
    static RECENT: RefCell<Vec<(Purpose, Rc<Compiled>)>> = const { RefCell::new(Vec::new()) };
}

impl Compiled {
    /// Compiles a model for which
    /// [`runs_side_by_side`](crate::composed::Composed::runs_side_by_side) is true, or finds it in
    /// the cache.
    pub(super) fn of(
        spec: &Spec,
        wanted: &[usize],
        rows: &Rows,
        columns: &Columns<'_>,
    ) -> Rc<Self> {
        let purpose = Purpose {
            spec: *spec,
            wanted: wanted.to_vec(),
            mean_velocity: columns.mean_velocity.is_some(),
            uniform_step: rows.uniform_step().is_some(),
            settles: rows.starts().iter().any(|&(_, how)| how == Beginning::Settled),
        };
        RECENT
            .with_borrow_mut(|recent| {
                if let Some(place) = recent.iter().position(|(own, _)| *own == purpose) {
                    let found = recent.remove(place);
                    recent.push(found);
                } else {
                    if recent.len() == KEPT {
                        recent.remove(0);
                    }
                    let compiled = Rc::new(Self::compile(&purpose));
                    recent.push((purpose, compiled));
                }
                recent.last().map(|(_, compiled)| Rc::clone(compiled))
            })
            .unwrap_or_else(|| Rc::new(Self { schedule: Schedule::of(&[], &[]) }))
    }

    fn compile(purpose: &Purpose) -> Self {
        let recorder = Recorder::default();
        let (torque, dry) = torque(purpose, &recorder);
        let torque = recorder.id(torque);
        let bottlenecks: Vec<_> = dry.map(|dry| recorder.id(dry)).into_iter().collect();
        let slopes = graph::derivatives(&recorder, &[torque], &bottlenecks, &purpose.wanted);
        let mut outputs = vec![torque];
        outputs.extend(slopes.iter().flatten().map(|&slope| recorder.id(slope)));
        let schedule = Schedule::of(&recorder.operations(), &outputs);
        Self { schedule }
    }

    /// Writes torque and derivatives, sample by sample. `look` sees each block. Returns whether the
    /// results, the derivatives if there are any, are finite.
    pub(super) fn run(
        &self,
        values: &[f64],
        rows: &Rows,
        columns: &Columns<'_>,
        out: &mut Outputs<'_>,
        mut look: impl FnMut(&Range<usize>),
    ) -> bool {
        let mut finite = true;
        // With all that it captures the run takes eight words: larger ones are passed through memory,
        // and cheap laws took up to 8 % longer.
        self.each_block(
            values,
            rows,
            columns,
            #[inline(always)]
            |block, outputs| {
                look(&block);
                let torque_finite = outputs[0].copy_to(&mut out.torque[block.clone()]);
                let slopes = &outputs[1..];
                let width = slopes.len();
                finite &= slopes
                    .iter()
                    .fold(torque_finite || width > 0, |all, numbers| all & numbers.are_finite());
                let out = &mut out.slopes[block.start * width..block.end * width];
                for (k, slope) in slopes.iter().enumerate() {
                    // Turns -0 into 0: the sign of zero depends on the other derivatives requested.
                    slope.add_to_each(0.0, out[k..].iter_mut().step_by(width));
                }
            },
        );
        finite
    }

    /// Passes torque and derivatives of each block of samples to `sink`, which has the widest vectors
    /// only where it is inlined.
    pub(super) fn each_block(
        &self,
        values: &[f64],
        rows: &Rows,
        columns: &Columns<'_>,
        sink: impl FnMut(Range<usize>, &[Numbers<'_>]),
    ) {
        let channel = |&channel| columns.channels.get(channel).unwrap_or_default();
        let mut inputs: Vec<&[f64]> = Channel::ALL.iter().map(channel).collect();
        inputs.push(columns.mean_velocity.unwrap_or_default());
        let steps: Cow<'_, [f64]>;
        let mut parameters = values.to_vec();
        if let Some(dt) = rows.uniform_step() {
            parameters.push(dt);
        } else {
            steps = rows.steps();
            inputs.push(&steps);
        }
        let inputs = Inputs {
            parameters: &parameters,
            columns: &inputs,
            rows: rows.count(),
            start: columns.state.first().copied().unwrap_or(0.0),
            starts: rows.starts(),
        };
        graph::run(&self.schedule, &inputs, sink);
    }
}

/// Records the operations of the model: the torque, and the dry magnitude, on which a bristle's
/// step depends in several places.
fn torque<'r>(purpose: &Purpose, recorder: &'r Recorder) -> (Recorded<'r>, Option<Recorded<'r>>) {
    let spec = &purpose.spec;
    let column = |index| recorder.number(Operation::Column(index));
    let Ok((model, sample)) = graph::model(recorder, spec) else {
        return (Recorded::Known(f64::NAN), None);
    };
    if !model.has_state() {
        return (model.static_torque(&sample), None);
    }
    let mean_velocity = purpose.mean_velocity.then(|| column(MEAN_VELOCITY));
    let dt = if purpose.uniform_step {
        recorder.number(Operation::Parameter(spec.parameter_count()))
    } else {
        column(STEP)
    };
    let sample = model.acting(&sample);
    let interval = Interval { sample, mean_velocity, dt, mean: false };
    let split = model.split_over(&mut &*recorder, &interval);
    let Some(bristle) = model.bristle(&sample) else {
        let torque = split.torque(sample.velocity.sign());
        return (model.measured(torque, &sample), None);
    };
    let end = split.dry();
    let velocity = interval.velocity();
    let dry = match mean_velocity {
        Some(_) => {
            let before = recorder.number(Operation::Previous(recorder.id(end)));
            (before + end).scale(Recorded::Known(0.5))
        }
        None => end,
    };
    let course = bristle.course(dry, velocity, dt);
    let shift = match mean_velocity {
        Some(_) => bristle.shift(&course, [dry, end], [velocity, sample.velocity]),
        None => Recorded::Known(0.0),
    };
    let settled =
        if purpose.settles { bristle.target(end, sample.velocity) } else { Recorded::Known(0.0) };
    let [before, after] = recorder.relax(course.share, course.target, shift, settled, Start::Given);
    let rate = match mean_velocity {
        Some(_) => bristle.rate(after, end, sample.velocity),
        None => course.end_rate(before),
    };
    (model.measured(bristle.torque(after, rate, &split), &sample), Some(end))
}

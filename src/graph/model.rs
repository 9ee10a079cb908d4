//! Records the operations of a model as a graph.

use std::vec::Vec;

use super::operation::Operation;
use super::recorded::{Format, Recorded};
use super::recorder::Recorder;
use crate::composed::{Composed, Spec};
use crate::error::ModelError;
use crate::sample::Sample;
use crate::scalar::Real;
use crate::table::Channel;

/// A model and its sample, in numbers of a recorder.
type RecordedModel<'r, F> = (Composed<Recorded<'r, F>>, Sample<Recorded<'r, F>>);

/// A model and the sample it reads: parameters by index, channels as columns by number; channels
/// that it does not read are 0.
///
/// # Errors
/// As [`Spec::with`].
pub fn model<'r, F: Format>(
    recorder: &'r Recorder,
    spec: &Spec,
) -> Result<RecordedModel<'r, F>, ModelError<'static>> {
    let parameters: Vec<Recorded<'r, F>> = (0..spec.parameter_count())
        .map(|index| recorder.number(Operation::Parameter(index)))
        .collect();
    let read: Vec<Channel> = spec.channels().collect();
    let sample = Sample::of(|channel| {
        if read.contains(&channel) {
            recorder.number(Operation::Column(channel as usize))
        } else {
            Recorded::zero()
        }
    });
    Ok((spec.with(&parameters)?, sample))
}

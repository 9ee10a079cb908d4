//! The derivative with respect to the lag of a thermometer, of models that are evaluated sample by
//! sample.
//!
//! Their numbers with derivatives do not differentiate by what a sample contains. The lag shifts
//! the temperature by `tau dT/dt`, so the derivative is that along a change `dT/dt` of it, by
//! central differences.

use std::vec;
use std::vec::Vec;

use super::columns::{Channels, Columns};
use super::error::BatchError;
use super::{Locked, Outputs, first_parameter, samples};
use crate::catalog::EffectId;
use crate::composed::Spec;

/// Largest change of the temperature (K): a change of 1e-3 K leaves errors of 1e-9 and less, both
/// of rounding and of curvature.
const STEP: f64 = 1e-3;

/// Writes the derivatives with respect to the lag, if it is among the `wanted` parameters.
pub(super) fn settle_slopes(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    slopes: &mut [f64],
) -> Result<(), BatchError> {
    let Some(lag) = first_parameter(spec, EffectId::ThermometerLag) else { return Ok(()) };
    let Some(own) = wanted.iter().position(|&index| index == lag) else { return Ok(()) };
    let rates = [columns.channels.temperature_rate, columns.smooth.temperature_rate];
    let fastest =
        rates.into_iter().flatten().flatten().fold(0.0, |most, rate| rate.abs().max(most));
    if fastest == 0.0 {
        return Ok(());
    }
    let step = STEP / fastest;
    let [above, below] = [step, -step].map(|step| torque(spec, values, columns, step));
    let rows = slopes.chunks_exact_mut(wanted.len());
    for ((row, above), below) in rows.zip(above?).zip(below?) {
        row[own] = (above - below) / (2.0 * step);
    }
    Ok(())
}

/// The torque of every sample with a lag that is longer by `step`.
fn torque(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    step: f64,
) -> Result<Vec<f64>, BatchError> {
    let ahead = |read: &Channels<'_>, rate: Option<&[f64]>| {
        let (temperature, rate) = (read.temperature?, rate?);
        let pairs = temperature.iter().zip(rate);
        Some(pairs.map(|(temperature, rate)| temperature + step * rate).collect::<Vec<f64>>())
    };
    let channels = ahead(&columns.channels, columns.channels.temperature_rate);
    let smooth = ahead(&columns.smooth, columns.smoothed().channels.temperature_rate);
    let shifted = Columns {
        channels: Channels { temperature: channels.as_deref(), ..columns.channels },
        smooth: Channels { temperature: smooth.as_deref(), ..columns.smooth },
        ..*columns
    };
    let mut torque = vec![0.0; columns.channels.velocity.len()];
    let outputs = Outputs { torque: &mut torque, slopes: &mut [] };
    samples::each::<f64>(spec, values, &shifted, &[], Locked::Amplified, outputs)?;
    Ok(torque)
}

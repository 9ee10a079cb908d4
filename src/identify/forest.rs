//! Extremely randomised trees: a regressor that needs no formula.

use core::fmt;
use std::string::{String, ToString};
use std::vec::Vec;

use smartcore::ensemble::extra_trees_regressor::{
    ExtraTreesRegressor, ExtraTreesRegressorParameters,
};
use smartcore::error::Failed;
use smartcore::linalg::basic::matrix::DenseMatrix;

/// Extremely randomised trees, which have learned a value from the features of each sample.
///
/// Every split tries all features, each at one random threshold. The random numbers are always the
/// same, so that equal samples give equal trees.
///
/// Source: Geurts, Ernst and Wehenkel 2006, "Extremely randomized trees".
///
/// ```
/// # use stribeck::identify::Forest;
/// let features: Vec<f64> = (0..400).map(f64::from).collect();
/// let values: Vec<f64> = features.iter().map(|x| x * x).collect();
/// let forest = Forest::new(&features, 1, &values, 40, 5).expect("finite samples");
/// let predicted = forest.predict(&[200.5], 1).expect("one feature")[0];
/// assert!((predicted / 200.5_f64.powi(2) - 1.0).abs() < 0.1);
/// ```
pub struct Forest {
    trees: ExtraTreesRegressor<f64, f64, DenseMatrix<f64>, Vec<f64>>,
}

/// Why trees cannot learn from samples or predict them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ForestError(String);

impl fmt::Display for ForestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for ForestError {}

impl From<Failed> for ForestError {
    fn from(failed: Failed) -> Self {
        Self(failed.to_string())
    }
}

impl Forest {
    /// Trees that have learned `values` `[m]` from `features` `[m, columns]`, row by row.
    ///
    /// # Errors
    /// No sample, no column, a number that is not finite, or arrays of different lengths.
    pub fn new(
        features: &[f64],
        columns: usize,
        values: &[f64],
        trees: usize,
        fewest_in_leaf: usize,
    ) -> Result<Self, ForestError> {
        if !values.iter().all(|value| value.is_finite()) {
            return Err(ForestError("a value is not finite".to_string()));
        }
        let parameters = ExtraTreesRegressorParameters::default()
            .with_n_trees(trees)
            .with_min_samples_leaf(fewest_in_leaf)
            .with_m(columns);
        let trees =
            ExtraTreesRegressor::fit(&matrix(features, columns)?, &values.to_vec(), parameters)?;
        Ok(Self { trees })
    }

    /// The mean of the trees' predictions of samples with `features` `[m, columns]`, row by row.
    ///
    /// # Errors
    /// As in [`Self::new`].
    pub fn predict(&self, features: &[f64], columns: usize) -> Result<Vec<f64>, ForestError> {
        Ok(self.trees.predict(&matrix(features, columns)?)?)
    }
}

fn matrix(features: &[f64], columns: usize) -> Result<DenseMatrix<f64>, ForestError> {
    if !features.iter().all(|feature| feature.is_finite()) {
        return Err(ForestError("a feature is not finite".to_string()));
    }
    if columns == 0 || features.is_empty() || !features.len().is_multiple_of(columns) {
        return Err(ForestError("features are not a table of whole rows".to_string()));
    }
    let by_column: Vec<f64> = (0..columns)
        .flat_map(|column| features.iter().skip(column).step_by(columns).copied())
        .collect();
    Ok(DenseMatrix::new(features.len() / columns, columns, by_column, true)?)
}

#[cfg(test)]
mod tests {
    use std::vec;

    use super::*;

    #[test]
    fn learns_the_same_trees_again_and_refuses_what_is_not_finite() {
        let features: Vec<f64> = (0..300).map(|i| f64::from(i * 37 % 101)).collect();
        let values: Vec<f64> = features.chunks(3).map(|row| row[0] - row[1] * row[2]).collect();
        let first = Forest::new(&features, 3, &values, 10, 2).expect("finite");
        let again = Forest::new(&features, 3, &values, 10, 2).expect("finite");
        let predicted = first.predict(&features, 3).expect("finite");
        assert_eq!(predicted, again.predict(&features, 3).expect("finite"));
        let error: f64 = predicted.iter().zip(&values).map(|(p, v)| (p - v) * (p - v)).sum();
        let spread: f64 = values.iter().map(|v| v * v).sum();
        assert!(error < 0.2 * spread, "{error} {spread}");

        let mut spoilt = features.clone();
        spoilt[7] = f64::NAN;
        assert!(Forest::new(&spoilt, 3, &values, 10, 2).is_err());
        assert!(Forest::new(&features, 3, &vec![f64::INFINITY; 100], 10, 2).is_err());
        assert!(Forest::new(&features, 7, &values, 10, 2).is_err());
        assert!(Forest::new(&[], 3, &[], 10, 2).is_err());
        assert!(Forest::new(&features, 3, &values[1..], 10, 2).is_err());
    }
}

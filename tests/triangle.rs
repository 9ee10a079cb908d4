//! Triangular factors of least-squares problems.
#![cfg(feature = "identify")]

use crate::common::close;
use stribeck::identify::triangles;

/// Sum of products of two columns of `R`.
fn product(factor: &[f64], width: usize, i: usize, j: usize) -> f64 {
    (0..width).map(|row| factor[row * width + i] * factor[row * width + j]).sum()
}

#[test]
fn a_factor_preserves_all_sums_of_products() {
    let n = 101;
    let jacobian: Vec<f64> = (0..n * 3).map(|k| ((k * k * 7) % 23) as f64 - 11.0).collect();
    let residual: Vec<f64> = (0..n).map(|k| ((k * 5) % 17) as f64 - 8.0).collect();
    let group: Vec<u32> = (0..n as u32).map(|k| k % 2).collect();
    let factors = triangles(&jacobian, 3, &residual, &group, 2).unwrap();
    for (g, made) in factors.iter().enumerate() {
        let part = made.factor();
        for i in 0..4 {
            let entry = |k: usize, i: usize| if i == 3 { residual[k] } else { jacobian[3 * k + i] };
            let rows = || (0..n).filter(|k| k % 2 == g);
            for j in 0..4 {
                let sum: f64 = rows().map(|k| entry(k, i) * entry(k, j)).sum();
                close(product(part, 4, i, j), sum, 1e-13);
            }
            assert!((0..i).all(|j| part[i * 4 + j] == 0.0));
        }
    }
}

/// Läuchli's columns (1, e, 0) and (1, 0, e): in the normal equations e^2 is lost next to 1.
#[test]
fn nearly_equal_columns_stay_distinct() {
    let e = 1e-9;
    let made = triangles(&[1.0, 1.0, e, 0.0, 0.0, e], 2, &[2.0, e, e], &[0; 3], 1).unwrap();
    let factor = made[0].factor();
    let second = factor[5] / factor[4];
    let first = (factor[2] - factor[1] * second) / factor[0];
    close(first, 1.0, 1e-6);
    close(second, 1.0, 1e-6);
}

#[test]
fn inconsistent_sizes_are_refused() {
    let refused = |jacobian: &[f64], p, group: &[u32]| {
        triangles(jacobian, p, &[1.0, 2.0], group, 2).unwrap_err().to_string()
    };
    assert_eq!(refused(&[1.0; 4], 2, &[0]), "'group' has 1 rows but 'residual' has 2");
    assert_eq!(refused(&[1.0; 6], 2, &[0, 0]), "'jacobian' has 3 rows but 'residual' has 2");
    assert_eq!(refused(&[1.0; 4], 2, &[0, 2]), "row 1 is in group 2 but there are 2 groups");
}

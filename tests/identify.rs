//! Separable least squares: the bounded solution, the search, and the linearisation of a model.
#![cfg(feature = "identify")]
#![allow(clippy::disallowed_methods)]

use std::cell::Cell;

use crate::common::close;
use crate::common::random::hold;
use proptest::collection::vec;
use proptest::prop_assert;
use stribeck::Spec;
use stribeck::batch::{self, BatchError, Channels, Columns, TimeStep};
use stribeck::identify::{
    Bounds, LeastSquares, NOT_SCORED, Outcome, Problem, Steps, Triangle, bounded_least_squares,
    minimise, triangles,
};

/// Gradient of half the squared error.
fn slopes(matrix: &[f64], right: &[f64], x: &[f64]) -> Vec<f64> {
    let p = x.len();
    let row = |i: usize| &matrix[i * p..(i + 1) * p];
    let left = |i: usize| row(i).iter().zip(x).map(|(a, x)| a * x).sum::<f64>() - right[i];
    (0..p).map(|k| (0..right.len()).map(|i| row(i)[k] * left(i)).sum()).collect()
}

#[test]
fn a_bounded_solution_is_optimal() {
    let met = Cell::new(0);
    let (rows, p) = (8, 4);
    let problems = (vec(-1.0..1.0, rows * p), vec(-1.0..1.0, rows), vec(0.0..1.2, p));
    hold(300, &problems, |(mut matrix, right, width)| {
        // Columns of very different lengths, as parameters of a law have.
        matrix.iter_mut().enumerate().for_each(|(i, x)| *x *= [1e-3, 1.0, 40.0, 1e5][i % p]);
        let reach: Vec<f64> =
            width.iter().zip([1e3, 1.0, 0.03, 1e-5]).map(|(x, s)| x * s).collect();
        let lower: Vec<f64> = reach.iter().map(|x| -x).collect();
        let x = bounded_least_squares(&matrix, &right, &lower, &reach);
        for (k, slope) in slopes(&matrix, &right, &x).into_iter().enumerate() {
            let small = 1e-9 * [1e-3, 1.0, 40.0, 1e5][k];
            prop_assert!((lower[k]..=reach[k]).contains(&x[k]));
            met.set(met.get() + usize::from(x[k] == lower[k] || x[k] == reach[k]));
            prop_assert!(slope <= small || x[k] == lower[k], "{k} would go down");
            prop_assert!(slope >= -small || x[k] == reach[k], "{k} would go up");
        }
        Ok(())
    });
    let met = met.get();
    assert!(met > 300, "bounds are active in only {met} cases");
}

#[test]
fn undetermined_directions_stay_at_zero() {
    let free = [f64::INFINITY; 3];
    let none = free.map(|x| -x);
    // The first two columns are equal, the third is zero.
    let x = bounded_least_squares(&[1.0, 1.0, 0.0, 2.0, 2.0, 0.0], &[2.0, 4.0], &none, &free);
    close(x[0], 1.0, 1e-14);
    close(x[1], 1.0, 1e-14);
    assert_eq!(x[2], 0.0);
    let infinite = [1.0, f64::NAN, 0.0];
    assert_eq!(bounded_least_squares(&infinite, &[1.0], &none, &free), [0.0; 3]);
}

/// y = a exp(-k t) + b, measured at several times.
struct Decay {
    time: Vec<f64>,
    measured: Vec<f64>,
}

impl Decay {
    fn new(a: f64, k: f64, b: f64) -> Self {
        let time: Vec<f64> = (0..50).map(|i| 0.1 * f64::from(i)).collect();
        let measured = time.iter().map(|t| a * (-k * t).exp() + b).collect();
        Self { time, measured }
    }
}

impl LeastSquares for Decay {
    type Error = BatchError;

    fn triangle(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Option<Triangle>, BatchError> {
        let [a, k, b] = [values[0], values[1], values[2]];
        let mut jacobian = vec![];
        let mut residual = vec![];
        for (t, y) in self.time.iter().zip(&self.measured) {
            let e = (-k * t).exp();
            let all = [e, -a * t * e, 1.0];
            jacobian.extend(wanted.iter().zip(slope).map(|(&own, slope)| all[own] * slope));
            residual.push(y - (a * e + b));
        }
        let group = vec![0; residual.len()];
        let mut made = triangles(&jacobian, wanted.len(), &residual, &group, 1)?;
        Ok(made.pop().filter(Triangle::is_finite))
    }

    fn torque_norm(&self) -> Result<f64, BatchError> {
        Ok(self.measured.iter().map(|y| y * y).sum::<f64>().sqrt())
    }
}

const CAUTIOUS: Steps = Steps { tolerance: 1e-18, max_steps: 60, damping: 1e-2 };

#[test]
fn a_search_finds_the_true_parameters() {
    let truth = [3.0, 1.7, -0.4];
    let decay = Decay::new(truth[0], truth[1], truth[2]);
    let free = [f64::INFINITY; 3];
    for logarithmic in [false, true] {
        let bounds = Bounds {
            lower: &free.map(|x| -x),
            upper: &free,
            linear: &[true, false, true],
            logarithmic: &[false, logarithmic, false],
        };
        let found = minimise(&decay, &[1.0, 0.05, 0.0], &bounds, CAUTIOUS).unwrap();
        assert!(matches!(found.outcome, Outcome::Converged | Outcome::ToRounding));
        for (value, truth) in found.values.iter().zip(truth) {
            close(*value, truth, 1e-9);
        }
    }
}

#[test]
fn bounds_hold_and_equal_bounds_fix_a_parameter() {
    let decay = Decay::new(3.0, 1.7, -0.4);
    let bounds = Bounds {
        lower: &[0.0, 0.1, 0.2],
        upper: &[2.5, 5.0, 0.2],
        linear: &[true, false, true],
        logarithmic: &[false; 3],
    };
    let found = minimise(&decay, &[9.0, 9.0, 9.0], &bounds, CAUTIOUS).unwrap();
    assert_eq!((found.values[0], found.values[2]), (2.5, 0.2));
    assert!(found.square > 0.1 && found.square < decay.torque_norm().unwrap().powi(2));
    let infinite =
        minimise(&decay, &[1.0, -1e6, 0.0], &Bounds { lower: &[-1e9; 3], ..bounds }, CAUTIOUS);
    assert_eq!(infinite.unwrap().outcome, Outcome::NotFinite);
}

#[test]
fn a_search_reports_insensitive_parameters() {
    // The optimal amplitude is zero, and then the decay has no influence.
    let decay = Decay::new(-3.0, 1.7, -0.4);
    let bounds = Bounds {
        lower: &[0.0, 0.1, -9.0],
        upper: &[9.0, 5.0, 9.0],
        linear: &[true, false, true],
        logarithmic: &[false; 3],
    };
    let found = minimise(&decay, &[1.0, 1.0, 0.0], &bounds, CAUTIOUS).unwrap();
    assert_eq!((found.values[0], found.insensitive), (0.0, vec![1]));
    let seen = minimise(&Decay::new(3.0, 1.7, -0.4), &[1.0, 1.0, 0.0], &bounds, CAUTIOUS).unwrap();
    assert!(seen.insensitive.is_empty());
}

/// y = 1 + |x - 0.3| + x / 4, which has a kink at its minimum, measured as zero.
struct Bend;

impl LeastSquares for Bend {
    type Error = BatchError;

    fn triangle(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Option<Triangle>, BatchError> {
        let apart = values[0] - 0.3;
        let by_x: Vec<f64> =
            wanted.iter().zip(slope).map(|(_, slope)| (apart.signum() + 0.25) * slope).collect();
        let residual = [-(1.0 + apart.abs() + 0.25 * values[0])];
        Ok(triangles(&by_x, wanted.len(), &residual, &[0], 1)?.pop())
    }

    fn torque_norm(&self) -> Result<f64, BatchError> {
        Ok(1.0)
    }
}

#[test]
fn a_search_ends_at_a_kink() {
    let bounds = Bounds { lower: &[-9.0], upper: &[9.0], linear: &[false], logarithmic: &[false] };
    let steps = Steps { tolerance: 1e-6, max_steps: 200, damping: 1e-2 };
    let found = minimise(&Bend, &[2.0], &bounds, steps).unwrap();
    assert_eq!(found.outcome, Outcome::Converged);
    close(found.values[0], 0.3, 1e-5);
}

fn motion(rows: usize) -> Vec<f64> {
    (0..rows)
        .map(|i| 0.3 * (0.02 * i as f64 + 0.4).sin() + 0.05 * (0.11 * i as f64).sin())
        .collect()
}

const LUGRE: [f64; 7] = [900.0, 8.0, 0.6, 2.0, 3.0, 0.05, 1.4];

fn problem<'a>(
    spec: &'a Spec,
    velocity: &'a [f64],
    target: &'a [f64],
    group: &'a [u32],
    begins: &'a [usize],
    moving: &'a [bool],
) -> Problem<'a> {
    let channels = Channels { velocity, ..Channels::default() };
    let columns = Columns { dt: TimeStep::Uniform(0.002), channels, ..Columns::default() };
    Problem {
        spec,
        columns,
        target,
        scale: None,
        group,
        groups: 2,
        begins,
        moving,
        torque_norm: 1.0,
        threads: 1,
    }
}

#[test]
fn a_weight_of_two_is_the_sample_twice() {
    let velocity = motion(300);
    let twice: Vec<f64> = velocity.iter().flat_map(|&v| [v, v]).collect();
    let target = |velocity: &[f64]| velocity.iter().map(|v| 2.5 * v.signum() + v * v).collect();
    let (once_target, twice_target): (Vec<f64>, Vec<f64>) = (target(&velocity), target(&twice));
    let spec = Spec::parse("coulomb").unwrap();
    let (group, moving) = (vec![0; 600], vec![true; 600]);
    let root = vec![2.0_f64.sqrt(); 300];
    let once = problem(&spec, &velocity, &once_target, &group[..300], &[], &moving[..300]);
    let once = Problem { groups: 1, scale: Some(&root), ..once };
    let double = problem(&spec, &twice, &twice_target, &group, &[], &moving);
    let double = Problem { groups: 1, ..double };
    let linearised = |problem: &Problem<'_>| {
        problem.triangles(&[1.0, 0.5], &[0, 1], &[1.0, 1.0]).unwrap().unwrap().remove(0)
    };
    let (one, two) = (linearised(&once), linearised(&double));
    for (x, y) in one.factor().iter().zip(two.factor()) {
        assert!((x.abs() - y.abs()).abs() < 1e-11 * (1.0 + y.abs()), "{x} {y}");
    }
    let short = Problem { scale: Some(&root[..299]), ..once };
    assert!(short.triangles(&[1.0, 0.5], &[0, 1], &[1.0, 1.0]).is_err());
}

#[test]
fn a_model_is_linearised_without_a_jacobian() {
    let velocity = motion(1000);
    let target: Vec<f64> = velocity.iter().map(|v| 2.5 * v.signum() + v).collect();
    let group: Vec<u32> = (0..1000).map(|i| [0, 1, NOT_SCORED][(i / 70) % 3]).collect();
    let moving = vec![true; 1000];
    let smooth: Vec<f64> = velocity.iter().map(|v| 0.9 * v).collect();
    // Segments, and steps of unequal length.
    let uneven: Vec<f64> = (0..1000)
        .map(|i| if [0, 313, 314].contains(&i) { 0.0 } else { 0.001 * f64::from(i % 3 + 1) })
        .collect();
    let delayed = [0.003, 0.006, 0.0, -0.0051, 0.2, -3.0].map(|delay| [2.0, 0.5, delay]);
    let cases = delayed
        .iter()
        .flat_map(|values| [("coulomb+delay", &values[..], true), ("coulomb+delay", values, false)])
        .chain([("lugre", &LUGRE[..], true), ("lugre", &LUGRE, false)]);
    for (text, values, uniform) in cases {
        let spec = Spec::parse(text).unwrap();
        let mut own = problem(&spec, &velocity, &target, &group, &[], &moving);
        own.columns.smooth.velocity = &smooth;
        own.columns.channels.load_torque = Some(&target);
        if !uniform {
            own.columns.dt = TimeStep::Each(&uneven);
        }
        let wanted: Vec<usize> = (0..values.len()).rev().collect();
        let slope: Vec<f64> = wanted.iter().map(|&k| 1.0 + k as f64).collect();
        let made = own.triangles(values, &wanted, &slope).unwrap().unwrap();
        let (torque, jacobian) =
            batch::gradient(&spec, values, &own.columns, Some(&wanted)).unwrap();
        let p = wanted.len();
        for (g, triangle) in made.iter().enumerate() {
            let summed = || (0..1000).filter(|&i| group[i] == g as u32);
            let entry = |i: usize, k: usize| match slope.get(k) {
                Some(slope) => jacobian[i * p + k] * slope,
                None => target[i] - torque[i],
            };
            for a in 0..=p {
                for b in 0..=p {
                    let sum: f64 = summed().map(|i| entry(i, a) * entry(i, b)).sum();
                    let same: f64 = (0..=p).map(|r| triangle.row(r)[a] * triangle.row(r)[b]).sum();
                    let size: f64 = summed().map(|i| (entry(i, a) * entry(i, b)).abs()).sum();
                    assert!((sum - same).abs() <= 1e-11 * size, "{text}: {a}, {b}");
                }
            }
        }
    }
}

#[test]
fn independent_samples_give_one_problem_on_any_threads() {
    const ROWS: usize = 150_000;
    let spec = Spec::parse("bittencourt_a").unwrap();
    let values = [2.0, 1.0, 0.05, 1.4, 0.6];
    let velocity = motion(ROWS);
    let target: Vec<f64> = velocity.iter().map(|v| 2.5 * v.signum() + v).collect();
    let group: Vec<u32> = (0..ROWS).map(|i| [0, 1, NOT_SCORED][(i / 50_000) % 3]).collect();
    let moving = vec![true; ROWS];
    let own = problem(&spec, &velocity, &target, &group, &[], &moving);
    let wanted = [0, 1, 2, 3, 4];
    let on = |threads| {
        let own = Problem { threads, ..own };
        own.triangles(&values, &wanted, &[1.0; 5]).unwrap().unwrap()
    };
    let one = on(1);
    assert_eq!(one, on(4), "equal bits on any number of threads");
    let (torque, jacobian) = batch::gradient(&spec, &values, &own.columns, None).unwrap();
    let entry =
        |i: usize, k: usize| if k < 5 { jacobian[i * 5 + k] } else { target[i] - torque[i] };
    for (rows, triangle) in [0..50_000, 50_000..100_000].into_iter().zip(&one) {
        for (a, b) in [(0, 0), (1, 3), (2, 5), (5, 5)] {
            let sum: f64 = rows.clone().map(|i| entry(i, a) * entry(i, b)).sum();
            let same: f64 = (0..6).map(|r| triangle.row(r)[a] * triangle.row(r)[b]).sum();
            let size: f64 = rows.clone().map(|i| (entry(i, a) * entry(i, b)).abs()).sum();
            assert!((sum - same).abs() <= 1e-11 * size, "{a}, {b}");
        }
    }
}

#[test]
fn the_initial_state_of_a_run_in_motion_is_found() {
    let spec = Spec::parse("lugre").unwrap();
    let velocity = motion(600);
    let (group, moving) = (vec![0; 600], vec![true; 600]);
    for slides in [true, false] {
        let mut steps = vec![0.002; 600];
        for begin in [0, 300] {
            steps[begin] = if slides { f64::INFINITY } else { 0.0 };
        }
        let channels = Channels { velocity: &velocity, ..Channels::default() };
        let columns = Columns { dt: TimeStep::Each(&steps), channels, ..Columns::default() };
        let target = batch::torque(&spec, &LUGRE, &columns).unwrap();
        steps[0] = 0.0;
        steps[300] = 0.0;
        let columns = Columns { dt: TimeStep::Each(&steps), channels, ..Columns::default() };
        let own =
            Problem { columns, ..problem(&spec, &velocity, &target, &group, &[0, 300], &moving) };
        assert_eq!(own.slides(&LUGRE).unwrap(), [slides; 2]);
        let made = own.triangles(&LUGRE, &[0], &[1.0]).unwrap().unwrap();
        assert!(made[0].square() < 1e-20);
    }
}

#[test]
fn inconsistent_sizes_are_refused() {
    let spec = Spec::parse("coulomb").unwrap();
    let velocity = motion(4);
    let refused = |target: &[f64], group: &[u32], begins: &[usize]| {
        let own = problem(&spec, &velocity, target, group, begins, &[true; 4]);
        own.triangles(&[1.0, 1.0], &[0], &[1.0]).unwrap_err().to_string()
    };
    assert_eq!(refused(&[0.0; 3], &[0; 4], &[]), "column 'target' has 3 rows but 'velocity' has 4");
    assert_eq!(refused(&[0.0; 4], &[2; 4], &[]), "row 0 is in group 2 but there are 2 groups");
    assert_eq!(
        refused(&[0.0; 4], &[0; 4], &[4]),
        "a run begins at row 4 but there are 4 rows, from 0"
    );
}

//! A law selected at compile time has the bits of the same law from the catalog.
#![cfg(feature = "std")]

use crate::common::{motion, values};
use stribeck::catalog::LawId;
use stribeck::law;
use stribeck::{Constants, FixedLaw, ModelError, Sample, Spec, State};

const ROWS: usize = 500;

macro_rules! laws {
    ($($law:ident),+ $(,)?) => {
        fn check(id: &str) -> bool {
            $(check_law!($law, id);)+
            false
        }
    };
}

macro_rules! check_law {
    ($law:ident, $id:ident) => {
        if <law::$law<f64> as law::FrictionLaw<f64>>::INFO.id == $id {
            in_format!(f64, $law, $id);
            in_format!(f32, $law, $id);
            return true;
        }
    };
}

macro_rules! in_format {
    ($float:ident, $law:ident, $id:ident) => {
        let spec = Spec::new($id, []).unwrap();
        let values: Vec<$float> = values(&spec).into_iter().map(|x| x as $float).collect();
        let composed = spec.with(&values).unwrap();
        let fixed =
            FixedLaw::<law::$law<$float>, $float>::from_values(&values, &Constants::default())
                .unwrap();
        let (mut state, mut same_state) = (State::default(), State::default());
        let motion = motion(ROWS);
        let dt = motion.dt as $float;
        for i in 0..ROWS {
            let channels = motion.columns().channels;
            let sample = Sample::of(|channel| channels.get(channel).unwrap()[i] as $float);
            let expected = composed.step(&mut state, &sample, dt).torque;
            let torque = fixed.torque(&mut same_state, &sample, dt);
            assert_eq!(torque.to_bits(), expected.to_bits(), "{} {} {i}", $id, stringify!($float));
        }
    };
}

laws! {
    Coulomb, BittencourtA, Clochiatti, Dong, GazA, GazB, GrotjahnA, GrotjahnB, HaoA, IndriA,
    Makkar, Shao, Wolf, Zhou, BittencourtB, HaoB, Iskandar, Li, Madsen, Nevmerzhitskiy, Simoni,
    Dahl, Lugre, IndriB, TadeseT, TadeseFull, Xiao, BlimanSorine, Elastoplastic, Leuven, Gms,
    GantryMap, IndriStatic, M0, M1, MStar, KarahanKarci, BamM1, BamM2, BamM3, BamM4, BamM5, BamM6,
}

#[test]
fn every_fixed_law_equals_that_of_the_catalog() {
    for law in LawId::ALL {
        assert!(check(law.info().id), "{} is not in the list above", law.info().id);
    }
}

#[test]
fn values_are_checked() {
    let with = |values: &[f32]| {
        FixedLaw::<law::Lugre<f32>, f32>::from_values(values, &Constants::default()).unwrap_err()
    };
    assert_eq!(with(&[1.0; 6]), ModelError::Count { expected: 7, given: 6 });
    let refused = with(&[1e4, 10.0, 1.0, 2.0, 3.0, 0.0, 2.0]);
    assert_eq!(refused, ModelError::Value { parameter: "stribeck_velocity", value: 0.0 });
}

//! The examples compile without warnings and print the expected output.

#![cfg(target_os = "linux")]

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use stribeck::law::Lugre;
use stribeck::{Feedforward, FixedLaw, Limits, Sample, Source};

const LIBRARIES: [&str; 2] = ["libstribeck_c.a", "libstribeck_c.so"];

const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror"];

/// The folder of the libraries built by cargo.
fn libraries() -> PathBuf {
    let test = env::current_exe().expect("the test has a path");
    test.parent().expect("target/PROFILE/deps/TEST").to_path_buf()
}

/// The output of a program linked to the library; `None` without a compiler.
fn printed(compiler: &str, standard: &str, source: &str, library: &str) -> Option<String> {
    if Command::new(compiler).arg("--version").output().is_err() {
        eprintln!("skipped: there is no {compiler} here");
        return None;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let libraries = libraries();
    let program = libraries.join(format!("{source}.{library}.program"));
    let mut compile = Command::new(compiler);
    compile.arg(standard).args(WARNINGS).arg("-I").arg(folder.join("include"));
    compile.arg(folder.join("examples").join(source)).arg("-o").arg(&program);
    compile.arg(libraries.join(library)).args(["-lm", "-lpthread", "-ldl"]);
    compile.arg(format!("-Wl,-rpath,{}", libraries.display()));
    let compiled = compile.output().expect("the compiler runs");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let ran = Command::new(&program).output().expect("the program runs");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    Some(String::from_utf8(ran.stdout).expect("text"))
}

/// The same calls in Rust, with numbers printed as in the program, without loss of digits.
fn control_loop() -> Vec<(f32, &'static str)> {
    let law = FixedLaw::new(Lugre {
        bristle_stiffness: 2000.0_f32,
        bristle_damping: 12.0,
        viscous_friction: 1.5,
        coulomb_friction: 2.0,
        static_friction: 2.7,
        stribeck_velocity: 0.08,
        stribeck_exponent: 2.0,
    });
    let limits = Limits { torque: 8.0, speed: 6.0, held: 1 };
    let mut joint = Feedforward::new(law, 0.00025, limits).expect("valid limits");
    let readings = [Some(0.5), Some(0.01), Some(-0.01), Some(-0.02), None, None];
    let feeds = readings.map(|velocity| joint.next(velocity.map(Sample::at).as_ref()));
    feeds
        .map(|feed| {
            let source = match feed.source {
                Source::Law => "law",
                Source::Limit => "limit",
                Source::Last => "last",
                Source::None => "none",
            };
            (feed.torque, source)
        })
        .to_vec()
}

#[test]
fn a_control_loop_in_c_has_the_bits_of_rust() {
    for library in LIBRARIES {
        let Some(output) = printed("cc", "-std=c11", "control_loop.c", library) else { continue };
        let rows: Vec<(f32, &str)> = output
            .lines()
            .filter_map(|line| line.split_once(' '))
            .map(|(torque, source)| (torque.parse().expect("a number"), source))
            .collect();
        assert_eq!(rows, control_loop(), "with {library}");
    }
}

#[test]
fn invalid_settings_are_refused_in_cpp() {
    for library in LIBRARIES {
        let Some(output) = printed("c++", "-std=c++17", "refused.cpp", library) else { continue };
        // -(1.5 x 1 + 2), 0 for a reading that is NaN, and 0 at rest.
        let expected = "the number of parameters is not that of the model\n4 parameters\n\
                        -3.5 law\n0 none\n0 law\n";
        assert_eq!(output, expected, "with {library}");
    }
}

//! The host program: hashes of the torques, one row per law; parameters; the motion.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::process::ExitCode;

use stribeck_firmware::{Joints, Motion, STEPS, VALUES, hash};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["hash", count] => count.parse().ok().and_then(hashes),
        ["parameters"] => Some(parameters()),
        ["trace", count, path] => count.parse().ok().and_then(|count| trace(count, path).ok()),
        _ => None,
    };
    if done.is_none() {
        eprintln!("usage: hash STEPS, parameters, or trace STEPS FILE");
        return ExitCode::from(2);
    }
    ExitCode::SUCCESS
}

fn hashes(count: u32) -> Option<()> {
    let mut joints = Joints::new()?;
    for (name, step) in STEPS {
        println!("{name} {:016x}", hash(&mut joints, *step, count));
    }
    Some(())
}

fn parameters() {
    for (name, values) in VALUES {
        let values: Vec<String> = values.iter().map(|x| format!("{x:?}")).collect();
        println!("{name} {}", values.join(" "));
    }
}

/// Velocity, temperature and load torque of each reading.
fn trace(count: u32, path: &str) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let mut motion = Motion::new();
    for _ in 0..count {
        let reading = motion.next();
        for x in [reading.velocity, reading.temperature, reading.load_torque] {
            file.write_all(&x.to_le_bytes())?;
        }
    }
    file.flush()
}

//! The hashes on the host, one row a law.

use stribeck_firmware::{Joints, STEPS, hash};

fn main() {
    let count = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let (Some(count), Some(mut joints)) = (count, Joints::new()) else {
        eprintln!("give the number of steps");
        std::process::exit(2);
    };
    for (name, step) in STEPS {
        println!("{name} {:016x}", hash(&mut joints, *step, count));
    }
}

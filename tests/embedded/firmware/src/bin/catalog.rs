//! The whole catalog, selected at run time, and the simulation of a joint, to measure code size.
#![no_std]
#![no_main]

use core::arch::global_asm;
use core::hint::black_box;
use core::panic::PanicInfo;

use stribeck::prelude::*;

global_asm!(include_str!("../reset.s"));

#[unsafe(no_mangle)]
extern "C" fn run() -> ! {
    let values = black_box([0.5_f32; 40]);
    if let Ok(spec) = Spec::new(black_box("lugre"), black_box(["load", "position"]))
        && let Some(values) = values.get(..spec.parameter_count())
        && let Ok(model) = spec.with(values)
    {
        let mut state = State::default();
        black_box(model.step(&mut state, &black_box(Sample::at(1.0)), 1e-3));
        black_box(model.settled(&black_box(Sample::at(1.0))));
    }
    loop {}
}

#[panic_handler]
fn panicked(_: &PanicInfo) -> ! {
    loop {}
}

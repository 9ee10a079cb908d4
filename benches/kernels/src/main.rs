//! Runs kernels for measurements: of instructions under an emulator, of time on this machine.
//!
//! ```console
//! stribeck-kernels list        # name and rows of each kernel
//! stribeck-kernels run NAME    # once to warm up, once inside `measured_run`
//! stribeck-kernels time        # name, rows and nanoseconds per row
//! stribeck-kernels peak        # peak number of operations per nanosecond of this machine
//! ```

mod elementary;
mod motion;
mod peak;
mod recordings;
mod timing;

use std::process::ExitCode;

/// A prepared kernel that can run repeatedly.
type Work = Box<dyn FnMut()>;

/// A name, the number of rows per run, and a function that prepares the kernel.
struct Kernel {
    name: &'static str,
    rows: usize,
    prepare: fn() -> Work,
}

/// All kernels, grouped by file.
fn kernels() -> impl Iterator<Item = &'static Kernel> {
    recordings::KERNELS.iter().chain(motion::KERNELS).chain(elementary::KERNELS)
}

/// The function whose instructions are counted; its name is unique in the program.
#[inline(never)]
fn measured_run(work: &mut Work) {
    work();
}

fn main() -> ExitCode {
    let said: Vec<String> = std::env::args().skip(1).collect();
    match said.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["list"] => kernels().for_each(|kernel| println!("{}\t{}", kernel.name, kernel.rows)),
        ["run", name] => {
            let Some(kernel) = kernels().find(|kernel| kernel.name == name) else {
                eprintln!("no kernel has the name {name}: see `list`");
                return ExitCode::from(2);
            };
            let mut work = (kernel.prepare)();
            work();
            measured_run(&mut work);
        }
        ["time"] => timing::print(kernels()),
        ["peak"] => peak::print(),
        _ => {
            eprintln!("usage: `list`, `run NAME`, `time` or `peak`");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

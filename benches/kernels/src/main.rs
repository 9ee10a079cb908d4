//! Runs kernels for those who measure: instructions under an emulator, time on the machine.
//!
//! ```console
//! stribeck-kernels list        # name and rows of each
//! stribeck-kernels run NAME    # once to warm up, once inside `measured_run`
//! stribeck-kernels time        # name, rows and nanoseconds a row
//! stribeck-kernels peak        # operations a nanosecond that the machine can do at most
//! ```

mod elementary;
mod motion;
mod peak;
mod recordings;
mod timing;

use std::process::ExitCode;

/// A kernel, ready to run again and again.
type Work = Box<dyn FnMut()>;

/// A name, how many rows a run goes through, and what makes it ready.
struct Kernel {
    name: &'static str,
    rows: usize,
    prepare: fn() -> Work,
}

/// All kernels, by what they belong to.
fn kernels() -> impl Iterator<Item = &'static Kernel> {
    recordings::KERNELS.iter().chain(motion::KERNELS).chain(elementary::KERNELS)
}

/// What is counted: the only function of this name in the program.
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
                eprintln!("no kernel is called {name}: `list` names them");
                return ExitCode::from(2);
            };
            let mut work = (kernel.prepare)();
            work();
            measured_run(&mut work);
        }
        ["time"] => timing::print(kernels()),
        ["peak"] => peak::print(),
        _ => {
            eprintln!("say `list`, `run NAME`, `time` or `peak`");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

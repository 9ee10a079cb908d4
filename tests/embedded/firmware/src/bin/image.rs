//! The firmware image: counts instructions per step and hashes the torques.
#![no_std]
#![no_main]

use core::arch::{asm, global_asm};
use core::hint::black_box;
use core::panic::PanicInfo;
use core::ptr;

use stribeck_firmware::{COUNTED, Joints, Motion, Number, PROBED, Reading, STEPS, Step, hash};

global_asm!(include_str!("../reset.s"));

/// Steps that are hashed: fewer where arithmetic is slow.
const HASHED: u32 = match u32::from_str_radix(env!("HASHED_STEPS"), 10) {
    Ok(count) => count,
    Err(_) => panic!("HASHED_STEPS is an integer"),
};
/// Instructions of the calibration: as many as fit between code and constants on a Cortex-M0.
const CALIBRATION: u32 = 250;

/// The system timer, which the emulator decrements per instruction.
const SYSTICK: [*mut u32; 3] =
    [0xe000_e010_u32 as *mut u32, 0xe000_e014_u32 as *mut u32, 0xe000_e018_u32 as *mut u32];
const LARGEST: u32 = 0x00ff_ffff;

#[unsafe(no_mangle)]
extern "C" fn run() -> ! {
    // SAFETY: every Cortex-M has the registers of this timer.
    unsafe {
        ptr::write_volatile(SYSTICK[1], LARGEST);
        ptr::write_volatile(SYSTICK[2], 0);
        ptr::write_volatile(SYSTICK[0], 5);
    }
    report("ticks", "calibration", [CALIBRATION.into(), calibration().into()]);
    let Some(mut joints) = Joints::new() else { exit() };
    for (name, step) in [("nothing", nothing as Step)].iter().chain(STEPS) {
        let [sum, largest] = count(&mut joints, *step);
        report("ticks", name, [COUNTED.into(), sum, largest]);
        report("stack", name, [stack(&mut joints, *step)]);
    }
    let Some(mut joints) = Joints::new() else { exit() };
    for (name, step) in STEPS {
        report("hash", name, [hash(&mut joints, *step, HASHED)]);
    }
    exit()
}

extern "C" fn nothing(_: &mut Joints, velocity: Number, _: Number, _: Number) -> Number {
    velocity
}

/// Sum and maximum of the ticks of a step.
fn count(joints: &mut Joints, step: Step) -> [u64; 2] {
    let step = black_box(step);
    let mut motion = Motion::new();
    let (mut sum, mut largest) = (0, 0);
    for _ in 0..COUNTED {
        let taken = u64::from(taken(joints, step, &motion.next()));
        sum += taken;
        largest = largest.max(taken);
    }
    [sum, largest]
}

/// Ticks of one step. Not inlined, so that nothing else runs between the two readings of the timer.
#[inline(never)]
fn taken(joints: &mut Joints, step: Step, reading: &Reading) -> u32 {
    let Reading { velocity, temperature, load_torque } = black_box(*reading);
    let before = ticks();
    black_box(step(joints, velocity, temperature, load_torque));
    before.wrapping_sub(ticks()) & LARGEST
}

fn ticks() -> u32 {
    // SAFETY: reading the timer has no effect.
    unsafe { ptr::read_volatile(SYSTICK[2]) }
}

/// Ticks of [`CALIBRATION`] instructions.
#[inline(never)]
fn calibration() -> u32 {
    let before = ticks();
    // SAFETY: `nop` has no effect.
    unsafe { asm!(".rept {count}", "nop", ".endr", count = const CALIBRATION) };
    before.wrapping_sub(ticks()) & LARGEST
}

/// Bytes below the stack pointer that a step has written.
#[inline(never)]
fn stack(joints: &mut Joints, step: Step) -> u64 {
    const DEPTH: usize = 4096;
    const UNTOUCHED: u32 = 0x5afe_c0de;
    let step = black_box(step);
    let mut motion = Motion::new();
    let mut deepest = 0;
    for _ in 0..PROBED {
        let reading = motion.next();
        let top: usize;
        // SAFETY: only free memory below the stack pointer is written; there are no interrupts.
        unsafe {
            asm!("mov {}, sp", out(reg) top);
            for offset in 1..=DEPTH / 4 {
                ptr::write_volatile((top - 4 * offset) as *mut u32, UNTOUCHED);
            }
        }
        black_box(step(joints, reading.velocity, reading.temperature, reading.load_torque));
        let mut offset = DEPTH;
        // SAFETY: the same bytes.
        while offset > 0 && unsafe { ptr::read_volatile((top - offset) as *const u32) } == UNTOUCHED
        {
            offset -= 4;
        }
        deepest = deepest.max(offset);
    }
    deepest as u64
}

/// Writes one row: words and hexadecimal numbers.
fn report<const N: usize>(kind: &str, name: &str, numbers: [u64; N]) {
    write(kind);
    write(" ");
    write(name);
    for number in numbers {
        write(" ");
        for digit in (0..16).rev() {
            let digit = (number >> (4 * digit)) as u8 & 15;
            put(if digit < 10 { b'0' + digit } else { b'a' - 10 + digit });
        }
    }
    put(b'\n');
}

fn write(text: &str) {
    for &byte in text.as_bytes() {
        put(byte);
    }
}

fn put(byte: u8) {
    semihosting(0x03, &raw const byte as usize);
}

fn exit() -> ! {
    loop {
        semihosting(0x18, 0x2_0026);
    }
}

/// Calls a service of the emulator.
fn semihosting(operation: usize, argument: usize) {
    // SAFETY: both services only read their arguments.
    unsafe { asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument) };
}

#[panic_handler]
fn panicked(_: &PanicInfo) -> ! {
    exit()
}

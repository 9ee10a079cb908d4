"""Images for a microcontroller: built, looked into, run in an emulator."""

from __future__ import annotations

import os
import re
import subprocess
import threading
from dataclasses import dataclass
from pathlib import Path

import toolchain

FIRMWARE = Path(__file__).resolve().parent / "firmware"
# What a program that cannot panic, does not allocate and computes with its own functions has not.
FORBIDDEN = re.compile(
    r"panic|slice_index|unwrap|alloc|^(exp|expm1|log|log2|pow|tanh|atan|sin|cos|fma)f?$"
)
FUSED = re.compile(r"\tvfn?m[as]")
INSTRUCTION = re.compile(r"^ *([0-9a-f]+):\t(\S+)(.*)")
BRANCH = re.compile(r"\t([0-9a-f]+) <")
# Host programs with other features have the same path: one is built and run at a time.
HOST = threading.Lock()


@dataclass(frozen=True)
class Tested:
    """What an image steps, and how many of a board's steps are hashed: one in `share`.

    `emulated_floats`: also on processors without floating-point hardware.
    """

    name: str
    features: tuple[str, ...]
    share: int
    emulated_floats: bool = True

    def steps(self, board: Board) -> int:
        """The number of steps that are hashed."""
        return board.hashed // self.share


# A step of the arm solves equations, within each other, so it takes longer.
TESTED = (
    Tested("every law", (), 1),
    Tested("the arm", ("arm",), 50),
    Tested("the robot", ("robot",), 50, emulated_floats=False),
)


@dataclass(frozen=True)
class Board:
    """A processor, how to build for it and the machine that QEMU emulates."""

    name: str
    target: str
    machine: str
    number: str
    hashed: int
    memory: int = 0x10000
    flags: str = ""
    # For a C compiler, where exported C and the C interface run too.
    c_flags: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        """Where its images are built."""
        return toolchain.BUILD / f"{self.name}-{self.number}"

    @property
    def tested(self) -> tuple[Tested, ...]:
        """What is stepped on it."""
        hardware = self.target.endswith("hf")
        return tuple(each for each in TESTED if hardware or each.emulated_floats)


BOARDS = (
    Board("Cortex-M0", "thumbv6m-none-eabi", "microbit", "f32", 20_000, 0x4000),
    Board("Cortex-M4", "thumbv7em-none-eabi", "mps2-an386", "f32", 20_000),
    Board(
        "Cortex-M4F",
        "thumbv7em-none-eabihf",
        "mps2-an386",
        "f32",
        1_000_000,
        c_flags=("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"),
    ),
    Board(
        "Cortex-M7",
        "thumbv7em-none-eabihf",
        "mps2-an500",
        "f64",
        1_000_000,
        flags="-Ctarget-cpu=cortex-m7",
        c_flags=("-mcpu=cortex-m7", "-mthumb", "-mfpu=fpv5-d16", "-mfloat-abi=hard"),
    ),
    Board(
        "Cortex-M7",
        "thumbv7em-none-eabihf",
        "mps2-an500",
        "f32",
        100_000,
        flags="-Ctarget-cpu=cortex-m7",
    ),
)


@dataclass(frozen=True)
class Answers:
    """What an image says of one law."""

    mean: float
    largest: float
    stack: int
    hash: str


def build(board: Board, binary: str, tested: Tested = TESTED[0]) -> Path:
    """Build one of the firmware's images, in place of the one before."""
    features = ",".join(("image", *_features(board.number, tested)))
    _cargo(
        board,
        *("build", f"--bin={binary}", f"--features={features}"),
        folder=FIRMWARE,
        hashed=tested.steps(board),
    )
    return board.folder / board.target / "release" / binary


def build_interface(board: Board) -> Path:
    """Link a program in C with the C interface's static library."""
    interface = toolchain.ROOT / "c"
    _cargo(
        board,
        *("rustc", "--package=stribeck-c", "--no-default-features", "--crate-type=staticlib"),
        folder=interface,
    )
    release = board.folder / board.target / "release"
    program = release / "interface"
    subprocess.run(
        [
            *("arm-none-eabi-gcc", *board.c_flags, "-std=c11", "-O2", "-ffreestanding"),
            *("-Wall", "-Wextra", "-Werror", "-nostdlib", f"-I{interface / 'include'}"),
            *(
                "-Wl,--gc-sections",
                "-Wl,-z,noexecstack",
                f"-Wl,--defsym=memory_size={board.memory}",
            ),
            *(f"-T{FIRMWARE / 'link.ld'}", FIRMWARE / "interface.c"),
            *(release / "libstribeck_c.a", "-o", program),
        ],
        check=True,
    )
    return program


def _features(number: str, tested: Tested) -> tuple[str, ...]:
    return (*tested.features, *(["double"] if number == "f64" else []))


def _cargo(board: Board, *arguments: str, folder: Path, hashed: int = 0) -> None:
    root = toolchain.sysroot(board.target)
    subprocess.run(
        [
            *("cargo", *arguments),
            *("--quiet", "--locked", "--release", f"--target={board.target}"),
        ],
        cwd=folder,
        env={
            **os.environ,
            "CARGO_TARGET_DIR": str(board.folder),
            "RUSTC": str(toolchain.RUSTC),
            "RUSTFLAGS": f"--sysroot={root} -Clinker=arm-none-eabi-ld -Clinker-flavor=ld "
            f"-Clink-arg=--defsym=memory_size={board.memory} "
            f"-Clink-arg=-T{FIRMWARE / 'link.ld'} {board.flags}",
            "HASHED_STEPS": str(hashed),
        },
        check=True,
    )


def refused(board: Board, image: Path) -> list[str]:
    """One sentence for everything that must not be in an image."""
    return [f"{image.name} for {board.name} contains {name}" for name in forbidden(image)]


def forbidden(image: Path) -> list[str]:
    """Symbols and instructions that must not be in an image."""
    symbols = subprocess.check_output(["arm-none-eabi-nm", "--demangle", image], text=True)
    names = [line.split(maxsplit=2)[-1] for line in symbols.splitlines()]
    fused = [line.strip() for line in _disassembled(image) if FUSED.search(line)]
    return [name for name in names if FORBIDDEN.search(name)] + fused


def sizes(image: Path, laws: list[str]) -> dict[str, int]:
    """Bytes of code and constants of each step, with all that it calls."""
    symbols = subprocess.check_output(["arm-none-eabi-nm", "--print-size", image], text=True)
    size_at, address_of = {}, {}
    for words in map(str.split, symbols.splitlines()):
        if len(words) == 4 and words[2] in "tTwW":
            address = int(words[0], 16) & ~1
            size_at[address] = int(words[1], 16)
            address_of[words[3]] = address
    calls: dict[int, set[int]] = {address: set() for address in size_at}
    within = 0
    for line in _disassembled(image):
        found = INSTRUCTION.match(line)
        if found is None:
            continue
        address = int(found[1], 16)
        within = address if address in size_at else within
        to = BRANCH.search(found[3])
        if found[2].startswith("b") and to is not None and int(to[1], 16) in size_at:
            calls.setdefault(within, set()).add(int(to[1], 16))
    return {law: sum(size_at[at] for at in _reached(address_of[law], calls)) for law in laws}


def _reached(start: int, calls: dict[int, set[int]]) -> set[int]:
    reached: set[int] = set()
    waiting = [start]
    while waiting:
        address = waiting.pop()
        if address not in reached:
            reached.add(address)
            waiting.extend(calls[address])
    return reached


def _disassembled(image: Path) -> list[str]:
    command = ["arm-none-eabi-objdump", "--disassemble", "--no-show-raw-insn", image]
    return subprocess.check_output(command, text=True).splitlines()


def emulator(board: Board, image: Path) -> list[str | Path]:
    """The command that runs an image."""
    return [
        *("qemu-system-arm", "-M", board.machine, "-nographic", "-monitor", "none"),
        *("-serial", "none", "-chardev", "stdio,id=said", "-semihosting-config"),
        *("enable=on,target=native,chardev=said", "-icount", "shift=6", "-kernel", image),
    ]


def run(board: Board, image: Path) -> dict[str, Answers]:
    """Run an image: what it says of each law. The emulator counts instructions, not cycles."""
    said = subprocess.check_output(
        emulator(board, image), text=True, stdin=subprocess.DEVNULL, timeout=240
    )
    rows = {(kind, name): numbers for kind, name, *numbers in map(str.split, said.splitlines())}

    def ticks(kind: str, name: str) -> list[int]:
        return [int(number, 16) for number in rows[kind, name]]

    instructions, calibration = ticks("ticks", "calibration")
    tick = instructions / calibration
    steps, empty, _ = ticks("ticks", "nothing")
    answers = {}
    for kind, name in rows:
        if kind == "hash":
            _, total, largest = ticks("ticks", name)
            stack = ticks("stack", name)[0] - ticks("stack", "nothing")[0]
            answers[name] = Answers(
                mean=(total - empty) / steps * tick,
                largest=(largest - empty / steps) * tick,
                stack=stack,
                hash=rows[kind, name][0],
            )
    return answers


def on_the_host(number: str, steps: int, tested: Tested = TESTED[0]) -> dict[str, str]:
    """The hashes that the host finds."""
    said = host_program(number, "hash", str(steps), tested=tested)
    return dict(line.split() for line in said.splitlines())


def host_program(number: str, *arguments: str, tested: Tested = TESTED[0]) -> str:
    """What the firmware's steps and motion say on the host."""
    command = ["cargo", "run", "--quiet", "--locked", "--release", "--bin=stribeck-firmware"]
    command += [f"--features={','.join(_features(number, tested))}"]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(toolchain.BUILD / "host")}
    with HOST:
        return subprocess.check_output(
            [*command, "--", *arguments], cwd=FIRMWARE, env=environment, text=True
        )

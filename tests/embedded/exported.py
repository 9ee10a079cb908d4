"""A minute at 4 kHz through Python and through exported C, on the host and on emulated boards."""

from __future__ import annotations

import subprocess
from pathlib import Path

import images
import numpy as np
import stribeck as sb
import toolchain

SOURCES = Path(__file__).resolve().parent / "exported"
#: A minute at 4 kHz.
STEPS = 240_000
PERIOD = 0.00025
CHANNELS = ("velocity", "temperature", "load_torque")
#: Names in the firmware that stand for a law with other parameters.
LAWS = {"lugre_squared": "lugre", "bittencourt_a_squared": "bittencourt_a"}
WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-ffp-contract=off")
NUMBERS = {"f32": (np.float32, "float", "uint32_t"), "f64": (np.float64, "double", "uint64_t")}


def differing(board: images.Board) -> list[str]:
    """Where Python, exported C and the crate do not answer alike, in sentences."""
    expected = images.on_the_host(board.number, STEPS)
    models = {name: _model(name, values) for name, values in _values(board.number).items()}
    folder = toolchain.BUILD / f"exported-{board.number}"
    sources = _write(folder, models, board.number)
    answers = {
        "Python": _by_python(models, board.number),
        "exported C on the host": _said(_for_host(folder, sources)),
        f"exported C on {board.name}": _said(
            *images.emulator(board, _for_board(folder, sources, board))
        ),
    }
    return [
        f"{where} has not the crate's bits of {name} in {board.number} over {STEPS} steps"
        for where, hashes in answers.items()
        for name, value in expected.items()
        if hashes.get(name) != value
    ]


def _values(number: str) -> dict[str, list[float]]:
    """The parameters that the firmware has."""
    rows = map(str.split, images.host_program(number, "parameters").splitlines())
    return {name: [float(value) for value in values] for name, *values in rows}


def _model(name: str, values: list[float]) -> sb.Model:
    return sb.model(LAWS.get(name, name)).with_values(values)


def _write(folder: Path, models: dict[str, sb.Model], number: str) -> list[Path]:
    """The exported sources, and the header that lists them."""
    _, real, bits = NUMBERS[number]
    lines = [
        '#include "board.h"',
        f"typedef {real} number;",
        f"typedef {bits} bits;",
        f"#define STEPS {STEPS}U",
        "typedef struct {",
        *(f"    number {channel};" for channel in CHANNELS),
        "} reading;",
    ]
    sources = []
    for name, model in models.items():
        written = sb.export(model, "c", folder, precision=number, name=name)
        sources.append(folder / f"{name}.c")
        assert sources[-1] in written.files
        sample = ", ".join(f".{c} = r->{c}" for c in CHANNELS if c in model.core.needs)
        lines += [
            f'#include "{name}.h"',
            f"static number {name}_torque(const reading *r, number dt)",
            "{",
            f"    static {name}_state state;",
            f"    const {name}_sample sample = {{{sample}}};",
            f"    return {name}_step(&{name}_fitted, &state, &sample, dt);",
            "}",
        ]
    lines += [
        "static const struct {",
        "    const char *name;",
        "    number (*torque)(const reading *r, number dt);",
        "} laws[] = {",
        *(f'    {{"{name}", {name}_torque}},' for name in models),
        "};",
    ]
    (folder / "laws.h").write_text("\n".join(lines) + "\n")
    return sources


def _for_host(folder: Path, sources: list[Path]) -> Path:
    program = folder / "on_host"
    _compile("gcc", *WARNINGS, *_files(folder, sources, "host.c"), "-o", program)
    return program


def _for_board(folder: Path, sources: list[Path], board: images.Board) -> Path:
    program = folder / f"on_{board.name}"
    link, reset = images.FIRMWARE / "link.ld", images.FIRMWARE / "src" / "reset.s"
    _compile(
        "arm-none-eabi-gcc",
        *board.c_flags,
        *WARNINGS,
        "-nostartfiles",
        "-Wl,-z,noexecstack",
        f"-Wl,--defsym=memory_size={board.memory}",
        f"-T{link}",
        reset,
        *_files(folder, sources, "board.c"),
        "-o",
        program,
    )
    return program


def _files(folder: Path, sources: list[Path], where: str) -> list[str | Path]:
    return [f"-I{folder}", f"-I{SOURCES}", SOURCES / "run.c", SOURCES / where, *sources]


def _compile(*words: str | Path) -> None:
    subprocess.run(words, check=True)


def _said(*command: str | Path) -> dict[str, str]:
    said = subprocess.check_output(command, text=True, stdin=subprocess.DEVNULL, timeout=300)
    return dict(line.split() for line in said.splitlines())


def _by_python(models: dict[str, sb.Model], number: str) -> dict[str, str]:
    """Hashes of what the Python package answers."""
    form = NUMBERS[number][0]
    trace = np.fromfile(_trace(number), dtype=form).reshape(STEPS, len(CHANNELS))
    hashes = {}
    for name, model in models.items():
        channels = {
            channel: trace[:, k].astype(float)
            for k, channel in enumerate(CHANNELS)
            if channel in model.core.needs
        }
        precision = "single" if number == "f32" else "double"
        torque = model.torque(**channels, dt=float(form(PERIOD)), precision=precision)
        hashes[name] = f"{_hash(torque.astype(form)):016x}"
    return hashes


def _trace(number: str) -> Path:
    path = toolchain.BUILD / f"trace-{number}"
    images.host_program(number, "trace", str(STEPS), str(path))
    return path


def _hash(torque: np.ndarray) -> int:
    """FNV-1a over bits, as in firmware/src/lib.rs."""
    hashed = 0xCBF29CE484222325
    for word in torque.view(f"u{torque.itemsize}").tolist():
        hashed = ((hashed ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return hashed

"""What builds and runs for a microcontroller: Debian's packages, Rust's core for each target."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import debian

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "embedded"
# A compiler beside rustup's, with the sources of its core.
RUSTC = Path("/usr/bin/rustc")
LIBRARY = Path("/usr/lib/rustlib/src/rust/library")
# Its core is built as sources are laid out since then; lists of packages may know older ones alone.
OLDEST = (1, 89)
# Headers of C's library.
NEWLIB = Path("/usr/lib/arm-none-eabi/include")
PACKAGES = (
    "rustc-web",
    "rust-web-src",
    "binutils-arm-none-eabi",
    "gcc-arm-none-eabi",
    "libnewlib-arm-none-eabi",
    "qemu-system-arm",
)
PROGRAMS = ("cargo", "arm-none-eabi-ld", "arm-none-eabi-objdump", "qemu-system-arm")

FLAGS = (
    "--edition=2024 --crate-type=lib --emit=metadata,link -Copt-level=3 -Cpanic=abort "
    "-Cembed-bitcode=yes -Zforce-unstable-if-unmarked --cap-lints=allow"
).split()
BUILTINS_FLAGS = ["-Ccodegen-units=10000", "-Cmetadata=cb"] + [
    f"--cfg={name}"
    for name in (
        'feature="compiler-builtins"',
        'feature="mem"',
        'feature="unstable-intrinsics"',
        "thumb",
        "f16_enabled",
        "f128_enabled",
        "intrinsics_enabled",
        "arch_enabled",
        "optimizations_enabled",
    )
]
BUILTINS_ENVIRONMENT = {
    "CFG_OPT_LEVEL": "3",
    "CFG_CARGO_FEATURES": "[]",
    "CFG_TARGET_FEATURES": "[]",
}


def missing() -> list[str]:
    """Programs and files that are not there."""
    names = [name for name in PROGRAMS if shutil.which(name) is None]
    names += [str(path) for path in (RUSTC, LIBRARY, NEWLIB) if not path.exists()]
    if RUSTC.exists() and tuple(map(int, version().split(".")[:2])) < OLDEST:
        names.append(f"a {RUSTC} newer than {version()}")
    return names


def version() -> str:
    """Of the compiler beside rustup's."""
    return subprocess.check_output([RUSTC, "--version"], text=True).split()[1]


def install() -> None:
    """Install Debian's packages where something is missing; Unavailable where that cannot be."""
    debian.install(PACKAGES, missing)


def sysroot(target: str) -> Path:
    """A folder with Rust's core for a target and nothing else: no alloc, no std."""
    root = BUILD / f"core-{version()}" / target
    done = root / "done"
    if done.exists():
        return root
    shutil.rmtree(root, ignore_errors=True)
    libraries = root / "lib" / "rustlib" / target / "lib"
    libraries.mkdir(parents=True)
    small = ["--cfg=thumb_1"] if target.startswith("thumbv6m") else []
    crates = (
        ("core", "core/src/lib.rs", ["-Ccodegen-units=1", "-Cmetadata=core"]),
        (
            "compiler_builtins",
            "compiler-builtins/compiler-builtins/src/lib.rs",
            BUILTINS_FLAGS + small,
        ),
    )
    for name, source, flags in crates:
        subprocess.run(
            [
                *(RUSTC, LIBRARY / source, f"--crate-name={name}", f"--target={target}"),
                *(f"--sysroot={root}", f"--out-dir={libraries}", *FLAGS, *flags),
            ],
            env={**os.environ, **BUILTINS_ENVIRONMENT, "RUSTC_BOOTSTRAP": "1"},
            check=True,
        )
    done.touch()
    return root

#!/usr/bin/env python3
"""Set up a virtual environment in .venv and run stribeck, its tests or its checks in it.

    python3 develop.py demo     build, then run `stribeck demo`
    python3 develop.py test     build, then run all Rust and Python tests
    python3 develop.py check    formatters, linters and type checks
    python3 develop.py slow     the long tests as well
    python3 develop.py embedded steps counted and compared on emulated microcontrollers
    python3 develop.py peers    times beside those of other packages (--bam FOLDER: BAM, too)
    python3 develop.py instructions  those of each kernel, counted (--write keeps the table)
    python3 develop.py scaling  how times grow, and how near they come to what the machine can do
    python3 develop.py setup    only build and install

Needs git, CPython >= 3.10 and stable Rust, nothing else: everything below is standard library.
Running it twice reuses what the first run made.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
PYTHON = BIN / ("python.exe" if os.name == "nt" else "python")
STAMP = VENV / "installed-for"
PEERS = ROOT / "target" / "peers"


def stop(sentence: str) -> None:
    print(f"develop.py: {sentence}", file=sys.stderr)
    raise SystemExit(2)


def run(*command: str | Path) -> None:
    words = [str(word) for word in command]
    print("+ " + " ".join(words), file=sys.stderr, flush=True)
    environment = {**os.environ, "VIRTUAL_ENV": str(VENV)}
    environment["PATH"] = f"{BIN}{os.pathsep}{environment.get('PATH', '')}"
    code = subprocess.run(words, cwd=ROOT, env=environment, check=False).returncode
    if code != 0:
        raise SystemExit(code)


def make_venv() -> None:
    if PYTHON.exists():
        return
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    missing = (
        f"Python's venv module is incomplete: install the package python{version}-venv "
        f"(Debian, Ubuntu: apt-get install python{version}-venv), then run this again"
    )
    try:
        import ensurepip  # noqa: F401  Debian leaves it out together with a working venv
        import venv
    except ImportError:
        stop(missing)
    try:
        venv.create(VENV, with_pip=True)
    except (OSError, subprocess.CalledProcessError):
        # A half-made environment would be taken for a good one next time.
        shutil.rmtree(VENV, ignore_errors=True)
        stop(missing)


def fingerprint() -> str:
    """Which sources the installed package was built from: modification times of what matters."""
    sources = [ROOT / "Cargo.toml", ROOT / "Cargo.lock", ROOT / "pyproject.toml"]
    sources += sorted((ROOT / "src").rglob("*.rs"))
    return "\n".join(f"{p.relative_to(ROOT)} {p.stat().st_mtime_ns}" for p in sources)


def setup() -> None:
    if sys.version_info < (3, 10):  # noqa: UP036  the message is for those who have an older one
        stop(f"needs CPython 3.10 or newer, this is {sys.version.split()[0]}")
    if shutil.which("cargo") is None:
        stop("needs stable Rust: cargo is not on the PATH (install it with rustup)")
    make_venv()
    now = fingerprint()
    if STAMP.exists() and STAMP.read_text() == now:
        return
    run(PYTHON, "-m", "pip", "install", "--quiet", "--editable", ".[test]")
    STAMP.write_text(fingerprint())


def demo() -> None:
    run(PYTHON, "-m", "stribeck", "demo", *sys.argv[2:])


def test() -> None:
    run("cargo", "test", "--quiet", "--locked")
    run("cargo", "test", "--quiet", "--locked", "--package", "stribeck-c")
    run("cargo", "build", "--quiet", "--locked", "--no-default-features")
    run(PYTHON, "-m", "pytest", "-q", "--doctest-modules", "python/stribeck")
    run(PYTHON, "-m", "pytest", "-q", "-n", "2", "-m", "not slow", *sys.argv[2:])


def slow() -> None:
    run(PYTHON, "-m", "pytest", "-q", "-n", "2", "-m", "slow", *sys.argv[2:])


def check() -> None:
    run("cargo", "fmt", "--all", "--check")
    run("cargo", "clippy", "--quiet", "--locked", "--workspace", "--all-targets",
        "--all-features", "--", "-D", "warnings")  # fmt: skip
    run(PYTHON, "-m", "ruff", "check", ".")
    run(PYTHON, "-m", "ruff", "format", "--check", ".")
    run(PYTHON, "-m", "mypy")
    run(PYTHON, "-m", "mypy.stubtest", "stribeck._core", "--ignore-disjoint-bases")


def embedded() -> None:
    run(PYTHON, "tests/embedded/run.py", *sys.argv[2:])


def instructions() -> None:
    run(PYTHON, "benches/kernels/instructions.py", *sys.argv[2:])


def peers() -> None:
    """Times beside those of other packages, which are installed apart, in one thread."""
    folder = ROOT / "benches" / "peers"
    run(PYTHON, "-m", "pip", "install", "--quiet", "--upgrade", "--target", PEERS,
        "-r", folder / "requirements.txt")  # fmt: skip
    in_one_thread()
    os.environ["PYTHONPATH"] = str(PEERS)
    run(PYTHON, folder / "ratios.py", *sys.argv[2:])


def scaling() -> None:
    in_one_thread()
    run(PYTHON, "benches/kernels/limits.py")
    run(PYTHON, "benches/scaling/run.py", "-o", "docs/scaling.png")


def in_one_thread() -> None:
    for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "POLARS_MAX_THREADS"):
        os.environ[threads] = "1"


TASKS = {
    "setup": lambda: None,
    "demo": demo,
    "test": test,
    "slow": slow,
    "check": check,
    "embedded": embedded,
    "instructions": instructions,
    "peers": peers,
    "scaling": scaling,
}


def main() -> None:
    task = sys.argv[1] if len(sys.argv) > 1 else ""
    if task not in TASKS:
        stop(f"say one of: {', '.join(TASKS)}")
    setup()
    TASKS[task]()


if __name__ == "__main__":
    main()

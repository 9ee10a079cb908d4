#!/usr/bin/env python3
"""Set up a virtual environment in .venv and run stribeck, its tests or its checks in it.

    python3 develop.py setup         build and install only
    python3 develop.py demo          run `stribeck demo`
    python3 develop.py test          run all Rust tests and the fast Python tests
    python3 develop.py rust          run all Rust tests
    python3 develop.py slow          run the slow tests
    python3 develop.py long          run the tests that take minutes each
    python3 develop.py check         run formatters, linters, type checks, import contracts, docs
    python3 develop.py docs          serve the documentation at http://127.0.0.1:8000
    python3 develop.py lock          update requirements.lock to the newest versions
    python3 develop.py oldest        run the fast Python tests with the oldest dependencies
    python3 develop.py audit         look for known vulnerabilities of the locked dependencies
    python3 develop.py mutants       change operators, which the tests must notice
    python3 develop.py embedded      compare and count steps on emulated microcontrollers
    python3 develop.py processors    compare an identification on emulated processors
    python3 develop.py instructions  count the instructions of each kernel (--write: keep the table)
    python3 develop.py peers         measure times against other packages (--bam FOLDER: also BAM)
    python3 develop.py papers        repeat the papers, and write docs/papers.md with its pictures
    python3 develop.py gallery       write docs/law_catalog.md, docs/effects.md and its pictures
    python3 develop.py scaling       measure how times grow, and how close they are to the limit

Needs git, CPython >= 3.10 and stable Rust. Every task builds what has changed first. This file uses
the standard library only; the versions that it installs are those of requirements.lock.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
PYTHON = BIN / ("python.exe" if os.name == "nt" else "python")
LOCK = ROOT / "requirements.lock"
STAMP = VENV / "installed-for"
PEERS = ROOT / "target" / "peers"
# A processor that has no tests left takes over some of the other's.
ON_BOTH = ("-n", "2", "--dist", "worksteal")
RUST_LOG = ROOT / "target" / "rust.log"


def stop(sentence: str) -> None:
    print(f"develop.py: {sentence}", file=sys.stderr)
    raise SystemExit(2)


def run(*command: str | Path) -> None:
    words = [str(word) for word in command]
    print("+ " + " ".join(words), file=sys.stderr, flush=True)
    environment = {**os.environ, "VIRTUAL_ENV": str(VENV)}
    environment["PATH"] = f"{BIN}{os.pathsep}{environment.get('PATH', '')}"
    began = time.monotonic()
    code = subprocess.run(words, cwd=ROOT, env=environment, check=False).returncode
    print(f"  {time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)
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
        # The next run would take an incomplete environment for a complete one.
        shutil.rmtree(VENV, ignore_errors=True)
        stop(missing)


def fingerprint() -> str:
    """Modification times of the sources that the installed package was built from."""
    sources = [ROOT / "Cargo.toml", ROOT / "Cargo.lock", ROOT / "pyproject.toml", LOCK]
    sources += sorted((ROOT / "src").rglob("*.rs"))
    return "\n".join(f"{p.relative_to(ROOT)} {p.stat().st_mtime_ns}" for p in sources)


def needs_cargo() -> None:
    if shutil.which("cargo") is None:
        stop("needs stable Rust: cargo is not on the PATH (install it with rustup)")


def setup() -> None:
    if sys.version_info < (3, 10):  # noqa: UP036  the message is for those who have an older one
        stop(f"needs CPython 3.10 or newer, this is {sys.version.split()[0]}")
    needs_cargo()
    make_venv()
    now = fingerprint()
    if STAMP.exists() and STAMP.read_text() == now:
        return
    # Python compiles what is imported; pip would compile all packages, on one processor.
    run(PYTHON, "-m", "pip", "install", "--quiet", "--no-compile", "--constraint", LOCK,
        "--editable", ".[test,docs]")  # fmt: skip
    STAMP.write_text(fingerprint())


def demo() -> None:
    run(PYTHON, "-m", "stribeck", "demo", *sys.argv[2:])


def rust() -> None:
    run("cargo", "test", "--quiet", "--locked", "--features", "identify")
    run("cargo", "test", "--quiet", "--locked", "--package", "stribeck-c")
    run("cargo", "build", "--quiet", "--locked", "--no-default-features")


def test() -> None:
    # The extension module is built on one processor: the Rust tests are built and run beside it.
    with rust_beside():
        setup()
        run(PYTHON, "-m", "pytest", "-q", *ON_BOTH, "--doctest-modules", "python/stribeck")
        run(PYTHON, "-m", "pytest", "-q", *ON_BOTH, "-m", "not slow and not long", *sys.argv[2:])


@contextmanager
def rust_beside() -> Iterator[None]:
    """Run the Rust tests beside what follows; their output comes at the end."""
    RUST_LOG.parent.mkdir(exist_ok=True)
    with RUST_LOG.open("wb") as log:
        # What is run meanwhile waits for the extension module: its build goes first.
        later = ["nice"] if shutil.which("nice") else []
        beside = subprocess.Popen(
            [*later, sys.executable, __file__, "rust"], stdout=log, stderr=subprocess.STDOUT
        )
    try:
        yield
    finally:
        code = beside.wait()
        print(RUST_LOG.read_text(errors="replace"), file=sys.stderr, flush=True)
    if code != 0:
        raise SystemExit(code)


def browser() -> None:
    """Install Debian's Chromium for the tests of the workbench; without it they are skipped."""
    present = any(map(shutil.which, ("chromium", "chromium-browser")))
    if present or shutil.which("apt-get") is None or not hasattr(os, "geteuid") or os.geteuid():
        return
    os.environ["DEBIAN_FRONTEND"] = "noninteractive"
    run("apt-get", "update", "-qq")
    run(
        "apt-get",
        "install",
        "-y",
        "-qq",
        "--no-install-recommends",
        "chromium",
        "fonts-dejavu-core",
    )


def slow() -> None:
    browser()
    run("cargo", "test", "--quiet", "--locked", "--release", "--test", "soak", "--", "--ignored")
    run(PYTHON, "-m", "pytest", "-q", *ON_BOTH, "-m", "slow", *sys.argv[2:])


def long() -> None:
    setup()
    run(PYTHON, "-m", "pytest", "-q", *ON_BOTH, "-m", "long", *sys.argv[2:])


def check() -> None:
    run("cargo", "fmt", "--all", "--check")
    run("cargo", "clippy", "--quiet", "--locked", "--workspace", "--all-targets",
        "--all-features", "--", "-D", "warnings")  # fmt: skip
    run(PYTHON, "-m", "ruff", "check", ".")
    run(PYTHON, "-m", "ruff", "format", "--check", ".")
    run(PYTHON, "-m", "mypy")
    run(PYTHON, "-m", "mypy.stubtest", "stribeck._core", "--ignore-disjoint-bases")
    run(BIN / "lint-imports", "--no-logo")
    run(PYTHON, "-m", "mkdocs", "build", "--quiet", "--strict", "--site-dir", "target/site")
    os.environ["RUSTDOCFLAGS"] = "-D warnings"
    for features in ("--all-features", "--no-default-features"):
        run("cargo", "doc", "--quiet", "--locked", "--no-deps", features)


def docs() -> None:
    run(PYTHON, "-m", "mkdocs", "serve", *sys.argv[2:])


def lock() -> None:
    run(PYTHON, "-m", "pip", "install", "--quiet", "uv")
    run(BIN / "uv", "pip", "compile", "--quiet", "--universal", "--python-version", "3.10",
        "--all-extras", "--upgrade", "--no-header", "--no-annotate",
        "--output-file", LOCK, "pyproject.toml")  # fmt: skip


def oldest() -> None:
    """Run the fast Python tests with the oldest supported version of each dependency."""
    venv = ROOT / "target" / "oldest"
    python = venv / BIN.name / "python"
    run(PYTHON, "-m", "pip", "install", "--quiet", "uv")
    run(BIN / "uv", "venv", "--quiet", "--clear", "--python", PYTHON, venv)
    run(BIN / "uv", "pip", "install", "--quiet", "--python", python,
        "--resolution", "lowest-direct", "--extra", "readers", "--extra", "robots",
        "-r", "pyproject.toml")  # fmt: skip
    # The tools of the tests may be new; the extension module is that of `setup`.
    run(BIN / "uv", "pip", "install", "--quiet", "--python", python, "--constraint", LOCK,
        "pytest", "pytest-timeout", "hypothesis", "mpmath", "syrupy", "distributed")  # fmt: skip
    os.environ["PYTHONPATH"] = str(ROOT / "python")
    run(python, "-m", "pytest", "-q", "-m", "not slow and not long", *sys.argv[2:])


def audit() -> None:
    """Look for known vulnerabilities of the locked dependencies; needs the network."""
    run(PYTHON, "-m", "pip", "install", "--quiet", "pip-audit")
    run(PYTHON, "-m", "pip_audit", "--disable-pip", "--no-deps", "-r", LOCK)


def mutants() -> None:
    """Change operators of the crate and of the package; the tests must notice."""
    if shutil.which("cargo-mutants") is None:
        run("cargo", "install", "--quiet", "--locked", "cargo-mutants")
    run(PYTHON, "-m", "pip", "install", "--quiet", "--constraint", LOCK, "cosmic-ray")
    run(PYTHON, "tests/mutation/run.py", *sys.argv[2:])


def embedded() -> None:
    run(PYTHON, "tests/embedded/run.py", *sys.argv[2:])


def processors() -> None:
    run(PYTHON, "tests/embedded/processors.py", *sys.argv[2:])


def instructions() -> None:
    run(PYTHON, "benches/kernels/instructions.py", *sys.argv[2:])


def peers() -> None:
    """Measure times against other packages, which are installed in a folder of their own."""
    folder = ROOT / "benches" / "peers"
    run(PYTHON, "-m", "pip", "install", "--quiet", "--upgrade", "--target", PEERS,
        "-r", folder / "requirements.txt")  # fmt: skip
    in_one_thread()
    os.environ["PYTHONPATH"] = str(PEERS)
    run(PYTHON, folder / "ratios.py", *sys.argv[2:])


def papers() -> None:
    run(PYTHON, "tests/studies/papers.py", *sys.argv[2:])


def gallery() -> None:
    in_one_thread()
    run(PYTHON, "tests/studies/gallery/laws.py")
    run(PYTHON, "tests/studies/gallery/page.py", *sys.argv[2:])


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
    "rust": rust,
    "slow": slow,
    "long": long,
    "check": check,
    "docs": docs,
    "lock": lock,
    "oldest": oldest,
    "audit": audit,
    "mutants": mutants,
    "embedded": embedded,
    "processors": processors,
    "instructions": instructions,
    "peers": peers,
    "papers": papers,
    "gallery": gallery,
    "scaling": scaling,
}


def main() -> None:
    task = sys.argv[1] if len(sys.argv) > 1 else ""
    if task not in TASKS:
        stop(f"say one of: {', '.join(TASKS)}")
    if task in ("test", "rust"):
        needs_cargo()
    else:
        setup()
    TASKS[task]()


if __name__ == "__main__":
    main()

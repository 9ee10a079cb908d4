"""The recipe of CONTRIBUTING.md for a new effect, followed in a copy of the tree.

`recipe/` holds the two files that the recipe asks for. Two rows in `src/effect/mod.rs` are all that
is edited; then the new effect is generated, diagnosed and named. The first build takes minutes,
on a busy machine many.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
RECIPE = Path(__file__).parent / "recipe"
#: A faster build than that of a wheel.
QUICK = {"CARGO_PROFILE_RELEASE_LTO": "off", "CARGO_PROFILE_RELEASE_CODEGEN_UNITS": "16"}


def run(command: list[str], folder: Path, **more: str) -> str:
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, **more}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


def add_row(text: str, before: str, row: str) -> str:
    """`text` with a row before another one, at its indent."""
    found = next(line for line in text.splitlines() if line.strip() == before)
    indent = found[: len(found) - len(found.lstrip())]
    return text.replace(f"{found}\n", f"{indent}{row}\n{found}\n", 1)


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the tree with the effect `surge`, its extension module built."""
    if shutil.which("cargo") is None:
        pytest.skip("cargo is not installed")
    copy = tmp_path_factory.mktemp("tree")
    for name in ("src", "c", "benches", "examples", "python", "docs", "tests"):
        hidden = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__", "target", "recipe")
        shutil.copytree(ROOT / name, copy / name, ignore=hidden)
    for name in ("Cargo.toml", "Cargo.lock"):
        shutil.copy(ROOT / name, copy / name)
    shutil.copy(RECIPE / "surge.rs", copy / "src" / "effect" / "surge.rs")
    shutil.copy(RECIPE / "surge.py", copy / "python" / "stribeck" / "effect" / "surge.py")
    rust = copy / "src" / "effect" / "mod.rs"
    text = add_row(rust.read_text(), "mod temperature_dry;", "mod surge;")
    rust.write_text(add_row(text, "quadrant: Quadrant,", "surge: Surge,"))
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "recipe"
    run(
        ["cargo", "rustc", "--release", "--lib", "--features", "python", "--crate-type", "cdylib"],
        copy,
        CARGO_TARGET_DIR=str(target),
        PYO3_BUILD_EXTENSION_MODULE="1",
        PYO3_PYTHON=sys.executable,
        **QUICK,
    )
    (built,) = (
        path
        for path in (target / "release").iterdir()
        if path.stem in ("libstribeck", "stribeck") and path.suffix in (".so", ".dylib", ".dll")
    )
    suffix = ".pyd" if built.suffix == ".dll" else ".abi3.so"
    shutil.copy(built, copy / "python" / "stribeck" / f"_core{suffix}")
    return copy


@pytest.mark.slow
@pytest.mark.minutes
@pytest.mark.timeout(3600)
def test_a_new_effect_is_generated_and_found(tree: Path) -> None:
    python = {"PYTHONPATH": str(tree / "python")}
    stribeck = [sys.executable, "-m", "stribeck"]
    run(
        [*stribeck, "generate", "--effect", "surge", "--seconds", "60", "-o", "made.parquet"],
        tree,
        **python,
    )
    answer = run([*stribeck, "diagnose", "made.parquet", "coulomb", "--json"], tree, **python)
    found = json.loads(answer)
    assert found["findings"][0]["effect"] == "surge"
    assert "higher at" in found["findings"][0]["where"]
    untested = {row["effect"] for row in found["untestable"]}
    assert "surge" not in untested


@pytest.mark.slow
@pytest.mark.minutes
@pytest.mark.timeout(3600)
def test_without_its_python_file_the_effect_is_refused(tree: Path) -> None:
    missing = tree / "python" / "stribeck" / "effect" / "surge.py"
    text = missing.read_text()
    missing.unlink()
    try:
        with pytest.raises(AssertionError, match=r"surge\.py must define EFFECT"):
            run(
                [sys.executable, "-c", "from stribeck.effect.registry import effects; effects()"],
                tree,
                PYTHONPATH=str(tree / "python"),
            )
    finally:
        missing.write_text(text)

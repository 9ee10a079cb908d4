"""`stribeck demo` and `stribeck generate`, as a user runs them."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import polars as pl
import pytest
import stribeck as sb

ROOT = Path(__file__).resolve().parents[3]


def run(*words: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "stribeck", *words],
        capture_output=True,
        text=True,
        timeout=300,
        cwd=folder,
        check=False,
    )


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path, float]:
    folder = tmp_path_factory.mktemp("demo")
    began = time.monotonic()
    done = run("demo", "--output", "out", folder=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout, folder / "out", time.monotonic() - began


def test_the_demo_tells_four_steps(told: tuple[str, Path, float]) -> None:
    shown, _, seconds = told
    for k, title in enumerate(("Compare", "Where it fails", "What is missing", "Add"), 1):
        assert f"\n{k}. {title}" in shown
    assert "The same effects were found." in " ".join(shown.split())
    assert "█" in shown
    assert max(map(len, shown.splitlines())) <= 100
    assert seconds < 60


def test_the_readme_shows_the_demo(told: tuple[str, Path, float]) -> None:
    """Its output in the README is that of today, but for the time and the folder."""
    shown = told[0]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    block = readme.partition("```text\n")[2].partition("\n```")[0]
    ours, theirs = (text.partition("\nWritten in")[0].strip() for text in (shown, block))
    assert ours == theirs


def test_the_demo_writes_a_report(told: tuple[str, Path, float]) -> None:
    _, out, _ = told
    assert sorted(p.name for p in out.iterdir()) == ["model.toml", "report.html", "report.png"]
    assert (out / "report.png").read_bytes().startswith(b"\x89PNG")
    assert "data:image/png" in (out / "report.html").read_text(encoding="utf-8")
    assert set(sb.load(out / "model.toml").effects) == {"load", "stribeck"}


@pytest.mark.slow
def test_the_demo_as_json(tmp_path: Path) -> None:
    done = run("demo", "--json", folder=tmp_path)
    answer = json.loads(done.stdout)
    assert {s["effect"] for s in answer["improve"]["steps"]} == set(answer["truth"]["hidden"])
    after = answer["improve"]["final"]["rmse_held_out"]
    assert after < 1.1 * answer["truth"]["noise_rms"]
    assert after < 0.3 * answer["improve"]["rmse_held_out_base"]


@pytest.mark.parametrize("ending", ["parquet", "csv"])
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_generate_writes_what_can_be_read(tmp_path: Path, ending: str, kind: str) -> None:
    name = f"made.{ending}"
    done = run(
        "generate",
        "-o",
        name,
        "--effect",
        "load",
        "--effect",
        "stribeck",
        "--seconds",
        "20",
        "--rate",
        "50",
        "--joint-kind",
        kind,
        "--json",
        folder=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    recording = sb.read(tmp_path / answer["path"])
    assert recording.joint_kind == kind
    assert len(recording) == answer["rows"] == 1000
    truth = json.loads((tmp_path / answer["truth_path"]).read_text(encoding="utf-8"))
    assert set(truth["hidden"]) == {"load", "stribeck"}


@pytest.mark.slow
def test_csv_and_parquet_hold_the_same_bits(tmp_path: Path) -> None:
    for ending in ("csv", "parquet"):
        done = run(
            "generate", "-o", f"a.{ending}", "--seconds", "20", "--rate", "50", folder=tmp_path
        )
        assert done.returncode == 0, done.stderr
        assert f"a.{ending}.truth.json" in done.stdout
    assert pl.read_csv(tmp_path / "a.csv").equals(pl.read_parquet(tmp_path / "a.parquet"))


@pytest.mark.parametrize(
    "words",
    [
        ("generate", "-o", "a.xlsx"),
        ("generate", "-o", "absent/a.csv"),
        ("generate", "-o", "a.csv", "--effect", "lod"),
        ("generate", "-o", "a.csv", "--seconds", "1"),
        ("generate", "-o", "a.csv", "--seed", "-1"),
        ("generate",),
        ("demo", "--output", "taken"),
    ],
)
def test_bad_input_ends_in_one_line(tmp_path: Path, words: tuple[str, ...]) -> None:
    (tmp_path / "taken").write_text("a file, no folder", encoding="utf-8")
    done = run(*words, folder=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    assert "unexpected" not in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["taken"]

"""`stribeck report` and `--report`, as a user runs them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from as_user import answer, stribeck

SHARED = Path(__file__).parents[4] / "shared"


@pytest.mark.slow
def test_the_report_of_a_file(plain_file: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    made = answer("report", plain_file, "--model", "coulomb", "--starts", 2, "-o", page)
    assert made["report"] == str(page) and made["improve"]["base"] == "coulomb"
    text = page.read_text()
    words = re.findall(r'<span class="word">([^<]*)</span>', text)
    told = ["stribeck", "report", str(plain_file), "--model", "coulomb", "--starts", "2"]
    assert words[: len(told)] == told
    for part in ("measured", "compared", "model", "left", "passivity", "data", "repeat"):
        assert f'id="{part}"' in text
    assert not re.search(r"<(script|img|link|iframe)[^>]*(src|href)=[\"']?(http|//)", text)


@pytest.mark.slow
def test_every_command_writes_the_same_kind_of_page(plain_file: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    for words in (
        ("fit", plain_file, "--model", "coulomb"),
        ("compare", plain_file, "coulomb", "coulomb+stribeck"),
    ):
        done = stribeck(*words, "--starts", 2, "--report", page)
        assert done.returncode == 0, done.stderr
        assert '<section id="repeat">' in page.read_text()


@pytest.mark.slow
def test_a_load_that_was_identified_is_known(plain_file: Path, tmp_path: Path) -> None:
    data, page = tmp_path / "free.csv", tmp_path / "page.html"
    pl.read_csv(plain_file).drop("load_torque").write_csv(data)
    done = stribeck("fit", data, "--model", "coulomb", "--starts", 2, "--report", page)
    assert done.returncode == 0, done.stderr
    text = page.read_text()
    assert "Load, identified with the friction" in text
    assert "the load torque is not known<" not in text


@pytest.mark.slow
def test_a_column_with_markup_is_text(plain_file: Path, tmp_path: Path) -> None:
    bad = "<script>alert(1)</script>"
    frame = pl.read_csv(plain_file).rename({"torque": bad})
    data, page = tmp_path / "odd.csv", tmp_path / "page.html"
    frame.write_csv(data)
    done = stribeck("fit", data, "--model", "coulomb", "--map", f"torque={bad}", "--report", page)
    assert done.returncode == 0, done.stderr
    assert bad not in page.read_text() and "&lt;script&gt;alert(1)" in page.read_text()


@pytest.mark.slow
def test_a_project_names_no_models_beside_it(plain_file: Path, tmp_path: Path) -> None:
    project, page = tmp_path / "p.toml", tmp_path / "page.html"
    assert stribeck("project", "new", project, plain_file, "--starts", 2).returncode == 0
    refused = stribeck("report", project, "--model", "lugre", "-o", page)
    assert refused.returncode == 2 and not refused.stdout and not page.exists()
    done = stribeck("report", project, "-o", page)
    assert done.returncode == 0, done.stderr
    assert 'id="left"' in page.read_text()


@pytest.mark.slow
def test_a_million_samples_stay_small(tmp_path: Path) -> None:
    rows = 1_000_000
    t = np.arange(rows) / 1000.0
    v = 0.9 * np.sin(0.7 * t) + 0.4 * np.sin(1.9 * t)
    noise = np.random.default_rng(0).standard_normal(rows)
    torque = 3.0 * np.sign(v) + 1.2 * v + 0.05 * noise
    data, page = tmp_path / "long.parquet", tmp_path / "page.html"
    pl.DataFrame(
        {"time": t, "velocity": v + 1e-4 * noise[::-1], "torque": torque, "load_torque": 0.0 * t}
    ).write_parquet(data)
    done = stribeck("fit", data, "--model", "coulomb", "--starts", 1, "--report", page)
    assert done.returncode == 0, done.stderr
    assert page.stat().st_size < 5_000_000
    assert "of the 1 000 000 samples" in page.read_text().replace("\u00a0", " ")


@pytest.mark.slow
@pytest.mark.skipif(not SHARED.is_dir(), reason="needs the published measurements")
def test_the_report_of_a_robot_joint(tmp_path: Path) -> None:
    data, page = SHARED / "data/ur10e/ur-20_01_22-joint_2.parquet", tmp_path / "page.html"
    options = ("--joint", 2, "--torque-constant", 10.6956, "--starts", 5)
    made = answer("report", data, *options, "-o", page)
    text = page.read_text()
    for step in made["improve"]["steps"]:
        assert f"<figcaption>Residual without and with {step['effect']};" in text
    for row in made["improve"]["untestable"]:
        assert row["effect"] in text

"""The papers repeated: what every reproduction holds, and some of its numbers."""

from __future__ import annotations

import json
import math
from pathlib import Path

import polars as pl
import pytest
from click.testing import CliRunner
from stribeck.base.errors import SpecError, StribeckError
from stribeck.benchmark.reproduce.page import write_reproduction
from stribeck.benchmark.reproduce.papers import PAPERS, reproduce
from stribeck.benchmark.reproduce.result import Reproduction, Row, last_digit
from stribeck.benchmark.reproduce.text import reproduction_text
from stribeck.cli.main import cli

pytestmark = pytest.mark.slow

#: Rows whose tolerance allows no doubt about what is compared: place and quantity.
KNOWN = {
    "gantry": ("table 1", "static friction"),
    "ur5e_review": ("table 4", "coulomb, std"),
    "indri": ("eq 14", "inertia_1"),
    "bittencourt": ("section II-B", "decay constant κ"),
    "tadese": ("table 2, joint 2", "sigma_1"),
}


@pytest.fixture(scope="module", params=PAPERS)
def made(request: pytest.FixtureRequest) -> Reproduction:
    return reproduce(request.param, quick=True)


def test_every_row_is_a_number_beside_a_number_with_a_reason(made: Reproduction) -> None:
    assert made.rows and made.data
    for row in made.rows:
        assert math.isfinite(row.paper) and math.isfinite(row.ours), row
        assert row.tolerance > 0.0 and row.why and row.where, row
    assert len(made.missed) < 0.5 * len(made.rows)


def test_a_known_row_is_met(made: Reproduction) -> None:
    place = KNOWN[made.paper]
    (row,) = [r for r in made.rows if (r.where, r.quantity) == place]
    assert row.within and row.tolerance < 0.2 * abs(row.paper)


def test_the_files_hold_all_rows_and_figures(made: Reproduction, tmp_path: Path) -> None:
    figures = write_reproduction(made, tmp_path)
    assert len(figures) == len(made.pictures) == len({p.name for p in made.pictures})
    stored = json.loads((tmp_path / "rows.json").read_text())
    assert stored["figures"] == figures
    assert len(stored["rows"]) == pl.read_csv(tmp_path / "rows.csv").height == len(made.rows)
    page = (tmp_path / f"{made.paper}.html").read_text()
    assert page.count("data:image/png") == len(figures) and "http" not in page


def test_a_file_of_the_user_is_not_replaced(made: Reproduction, tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text("mine")
    with pytest.raises(StribeckError, match=r"rows\.csv: a file that stribeck did not write"):
        write_reproduction(made, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["rows.csv"]


def test_the_text_names_every_miss(made: Reproduction) -> None:
    text = reproduction_text(made)
    assert text.count("MISS") == len(made.missed)
    assert max(map(len, text.splitlines())) <= 98


#: Most rows of a whole reproduction that may miss. The page of the documentation names each.
MOST_MISSES = {"gantry": 0, "ur5e_review": 90, "tadese": 5, "indri": 3, "bittencourt": 1}


@pytest.mark.long
@pytest.mark.parametrize("paper", PAPERS)
def test_the_whole_reproduction_misses_no_more_than_it_says(paper: str) -> None:
    whole = reproduce(paper)
    missed = [(row.where, row.quantity) for row in whole.missed]
    assert len(missed) <= MOST_MISSES[paper], missed
    assert KNOWN[paper] not in missed


def test_the_seed_fixes_every_number() -> None:
    first, again, other = (
        reproduce("gantry", seed=seed, quick=True).to_dict() for seed in (0, 0, 1)
    )
    assert first == again != other


def test_the_json_is_one_object(tmp_path: Path) -> None:
    made = CliRunner().invoke(
        cli, ["reproduce", "gantry", "--quick", "--json", "-o", str(tmp_path / "g")]
    )
    assert made.exit_code == 0
    assert set(json.loads(made.stdout)) >= {"paper", "rows", "figures"}
    assert all(Path(path).is_file() for path in json.loads(made.stdout)["figures"])


@pytest.mark.parametrize(
    ("meaning", "ours", "within"),
    [
        ("value", 1.2, False),
        ("at most", 0.2, True),
        ("at most", 1.2, False),
        ("at least", 1.2, True),
    ],
)
def test_a_limit_is_kept_on_one_side(meaning: str, ours: float, within: bool) -> None:
    row = Row("table", "x", "", 1.0, ours, 0.1, "", meaning)  # type: ignore[arg-type]
    assert row.within is within


def test_a_row_that_is_not_a_number_is_a_miss() -> None:
    assert not Row("table", "x", "", 1.0, math.nan, 1.0, "").within
    assert not Row("table", "x", "", 1.0, 1.0, math.nan, "").within


def test_half_a_unit_of_the_last_digit() -> None:
    assert last_digit("-25.00") == pytest.approx(0.005)
    assert last_digit("1.31e-3") == pytest.approx(5e-6)


def test_an_unknown_paper_is_refused() -> None:
    with pytest.raises(SpecError, match="did you mean 'tadese'"):
        reproduce("tadesse")

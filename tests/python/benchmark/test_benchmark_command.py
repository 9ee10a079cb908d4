"""`stribeck benchmark diagnosis` on a few recordings."""

from __future__ import annotations

import json
from pathlib import Path

import polars as pl
import pytest
from click.testing import CliRunner, Result
from stribeck.base.errors import StribeckError
from stribeck.base.pool import Stopped
from stribeck.benchmark import run as running
from stribeck.benchmark.answer import CaseAnswer, answer
from stribeck.benchmark.cases import Case, cases
from stribeck.benchmark.store import AnswerStore
from stribeck.cli.main import cli


def ask(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["benchmark", "diagnosis", "--workers", "1", *arguments])


@pytest.mark.slow
def test_a_case_is_answered_stored_and_scored(tmp_path: Path) -> None:
    folder = tmp_path / "board"
    only = ("--quick", "--only", "open_loop-offset-1x")
    result = ask(*only, "-o", str(folder), "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    assert said["cases"] == 1
    assert [group["of"] for group in said["groups"]] == [1, 1]
    assert said["confusion"]["rows"] == ["offset"]
    (ratio,) = said["held_out_over_oracle"]
    assert 0.9 < ratio["mean"] < 1.5
    table = pl.read_parquet(folder / "answers.parquet")
    assert table["case"].to_list() == [cases(1, only="open_loop-offset-1x")[0].name]
    for name in ("confusion.csv", "confusion.png", "calibration.png", "score.txt"):
        assert (folder / name).stat().st_size > 0
    again = ask(*only, "-o", str(folder))
    assert again.exit_code == 0
    assert (folder / "score.txt").read_text().strip() == again.stdout.strip()
    assert len((folder / "answers.jsonl").read_text().splitlines()) == 1


def test_coverage_is_printed() -> None:
    result = ask("--quick", "--only", "rho0.99")
    assert result.exit_code == 0, result.output
    assert "ordinary least squares" in result.stdout
    assert " 0.99          10 " in result.stdout


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--generator", "open_lop"), "did you mean 'open_loop'?"),
        (("--only", "gremlins"), "no case has 'gremlins' in its name"),
    ],
)
def test_a_wrong_word_ends_in_one_sentence(arguments: tuple[str, str], sentence: str) -> None:
    result = ask(*arguments)
    assert isinstance(result.exception, StribeckError)
    assert sentence in str(result.exception)


def test_a_run_that_is_stopped_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = [c for c in cases(1) if c.group == "coverage"][:3]
    asked: list[str] = []

    def counted(case: Case) -> CaseAnswer:
        if len(asked) == 1:
            raise KeyboardInterrupt
        asked.append(case.name)
        return CaseAnswer(case, verdict="none")

    monkeypatch.setattr(running, "answer", counted)
    with pytest.raises(Stopped):
        running.run(chosen, tmp_path / "board", workers=1)
    assert pl.read_parquet(tmp_path / "board" / "answers.parquet").height == 1

    def rest(case: Case) -> CaseAnswer:
        asked.append(case.name)
        return CaseAnswer(case, verdict="none")

    monkeypatch.setattr(running, "answer", rest)
    running.run(chosen, tmp_path / "board", workers=1)
    assert asked == [c.name for c in chosen]


def test_answers_of_another_program_are_not_added_to(tmp_path: Path) -> None:
    AnswerStore(tmp_path / "board").close()
    manifest = tmp_path / "board" / "manifest.json"
    said = json.loads(manifest.read_text())
    manifest.write_text(json.dumps({**said, "program": "another"}))
    with pytest.raises(StribeckError, match="another version"):
        AnswerStore(tmp_path / "board")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "notes.txt").write_text("mine")
    with pytest.raises(StribeckError, match="contains no benchmark"):
        AnswerStore(tmp_path / "other")


def test_an_answer_reads_back_the_same(tmp_path: Path) -> None:
    store = AnswerStore(tmp_path)
    made = answer(Case("coverage", "autoregressive", ("coulomb",), 4, correlation=0.9))
    store.add(made)
    store.close()
    assert AnswerStore(tmp_path).answers == {made.case.name: made}


def test_a_broken_case_is_an_answer() -> None:
    made = answer(Case("one", "open_loop", ("gremlins",), 1, 1.0))
    assert "gremlins" in made.failure


def test_cases_do_not_depend_on_how_many_are_asked_for() -> None:
    few, many = ({c.name for c in cases(n)} for n in (1, 3))
    assert few < many
    names = [c.name for c in cases(2)]
    assert len(set(names)) == len(names)
    assert not few & {c.name for c in cases(1, seed=1)}

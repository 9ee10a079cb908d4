"""The last result: printed again, its model saved, and never a reason to fail."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
import stribeck as sb
from stribeck.cli import kept
from stribeck.cli.main import main
from synthetic import joint

Said = tuple[int, str, str]


@pytest.fixture
def run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Said]:
    """Run the command in a folder with a recording and a cache of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(kept.SWITCH)
    monkeypatch.setattr(kept, "kept_path", lambda: tmp_path / "cache" / "stribeck" / "last.json")
    joint(rows=600).write_csv("joint.csv")

    def called(*words: str) -> Said:
        code = 0
        try:
            main(words)
        except SystemExit as done:
            code = int(done.code or 0)
        return code, *capsys.readouterr()

    return called


def test_it_is_printed_again_and_its_model_saved(run: Callable[..., Said]) -> None:
    text = run("fit", "joint.csv", "coulomb")[1]
    code, out, err = run("last")
    assert (code, out) == (0, text) and "stribeck fit joint.csv coulomb" in err
    saved = json.loads(run("last", "--json")[1])
    assert saved["model"] == "coulomb" and saved["rmse"] > 0.0
    assert run("last", "-o", "m.toml")[:2] == (0, "")
    fitted = sb.fit("coulomb", sb.read("joint.csv"))
    stored = sb.read_model_file("m.toml")
    assert stored.model.values.tobytes() == fitted.model.values.tobytes()
    assert stored.fitted_on["rmse"] == fitted.rmse and stored.stderr


def test_json_is_printed_as_json(run: Callable[..., Said]) -> None:
    out = run("add", "joint.csv", "coulomb", "offset", "--json")[1]
    assert json.loads(run("last")[1]) == json.loads(out)
    run("last", "-o", "m.toml")
    assert sb.load("m.toml").spec == "coulomb+offset"


def test_a_comparison_has_no_single_model(run: Callable[..., Said]) -> None:
    run("compare", "joint.csv", "coulomb", "coulomb+offset")
    code, out, err = run("last", "-o", "m.toml")
    assert (code, out) == (2, "") and "no single model" in err and not Path("m.toml").exists()


def test_there_is_none(run: Callable[..., Said], monkeypatch: pytest.MonkeyPatch) -> None:
    assert run("last")[0] == 2
    monkeypatch.setenv(kept.SWITCH, "off")
    run("fit", "joint.csv", "coulomb")
    assert "the variable STRIBECK_LAST switches it off" in run("last")[2]
    kept.kept_path().parent.mkdir(parents=True)
    kept.kept_path().write_text("{")
    assert "is damaged: remove it" in run("last")[2]


def test_a_cache_that_cannot_be_written_is_no_reason_to_fail(run: Callable[..., Said]) -> None:
    Path("cache").write_text("no folder")
    code, out, err = run("fit", "joint.csv", "coulomb")
    assert code == 0 and "coulomb fitted to joint.csv" in out and "last.json" not in err


def test_it_is_bounded(run: Callable[..., Said], monkeypatch: pytest.MonkeyPatch) -> None:
    run("fit", "joint.csv", "coulomb")
    whole = os.path.getsize(kept.kept_path())
    monkeypatch.setattr(kept, "MOST_BYTES", whole - 500)
    text = run("fit", "joint.csv", "coulomb")[1]
    assert run("last")[1] == text and "too large to be kept" in run("last", "--json")[2]
    monkeypatch.setattr(kept, "MOST_BYTES", 10)
    run("fit", "joint.csv", "coulomb")
    assert "no result is kept" in run("last")[2]


def test_where_it_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert kept.kept_path() == tmp_path / "stribeck" / "last.json"

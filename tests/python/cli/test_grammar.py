"""One grammar: DATA before models, one table of options, refusals that say why."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import click
import pytest
from stribeck.cli.commands import Commands
from stribeck.cli.main import main
from synthetic import joint

Said = tuple[int, str, str]
Run = Callable[..., Said]

#: Options of every fitting command.
OPTIONS = (
    "--bound --fix --start --constraint --tie --prior --weights --loss --algorithm --per-run "
    "--evaluate --moving-above --unwrap --trust"
).split()
#: Commands that fit, and those of the options that each refuses with a reason.
ROBOT = {
    "--bound", "--fix", "--start", "--constraint", "--tie", "--prior", "--loss", "--algorithm",
    "--per-run",
}  # fmt: skip
FITTING: dict[str, set[str]] = {
    "fit": set(),
    "compare": set(),
    "diagnose": {"--per-run"},
    "add": {"--per-run"},
    "improve": {"--per-run"},
    "study": {"--per-run"},
    "fleet": {"--per-run", "--evaluate"},
    "report": ROBOT | {"--evaluate"},
    "validate": ROBOT | {"--evaluate"},
    "project new": {
        "--bound",
        "--prior",
        "--constraint",
        "--tie",
        "--loss",
        "--algorithm",
        "--per-run",
        "--evaluate",
    },
    "plan": {"--per-run", "--evaluate"},
    "points": ROBOT | {"--evaluate"},
    "arm": ROBOT,
    "robot fit": ROBOT,
    "robot compare": ROBOT,
    "robot diagnose": ROBOT | {"--evaluate"},
    "robot improve": ROBOT,
}


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run the command in a folder with run1.csv, run2.csv and other.csv."""
    monkeypatch.chdir(tmp_path)
    for seed, name in enumerate(("run1.csv", "run2.csv", "other.csv")):
        joint(rows=800, seed=seed).write_csv(name)

    def called(*words: str) -> Said:
        code = 0
        try:
            main(words)
        except SystemExit as done:
            code = int(done.code or 0)
        out, err = capsys.readouterr()
        return code, out, err

    return called


def command(name: str) -> click.Command:
    """A command by the words that call it."""
    first, *rest = name.split()
    found = Commands().get_command(click.Context(click.Command("stribeck")), first)
    for word in rest:
        assert isinstance(found, click.Group)
        found = found.commands[word]
    assert found is not None
    return found


@pytest.mark.parametrize("name", FITTING)
def test_every_fitting_command_takes_or_refuses_every_option(name: str) -> None:
    options = {
        flag: param
        for param in command(name).params
        if isinstance(param, click.Option)
        for flag in param.opts
    }
    assert set(OPTIONS) <= set(options)
    assert {flag for flag in OPTIONS if options[flag].hidden} == FITTING[name]


def test_a_refused_option_says_why(run: Run) -> None:
    for words, said in (
        (["diagnose", "run1.csv", "coulomb", "--per-run", "offset"], "one value of each parameter"),
        (["fleet", "run1.csv", "--evaluate", "other.csv"], "stribeck fit --evaluate"),
        (["robot", "improve", "run1.csv", "--bound", "a1=0:1"], "stribeck fit --joint NAME"),
        (["project", "new", "p.toml", "run1.csv", "--tie", "a1 = a2"], "--fix holds"),
        (["points", "run1.csv", "--loss", "huber"], "stribeck fit"),
        (["arm", "run1.csv", "--prior", "a1=1+-1"], "linear least squares"),
    ):
        code, out, err = run(*words)
        assert (code, out) == (2, "") and "does not take --" in err and said in err


@pytest.mark.parametrize("old", [False, True])
def test_models_stand_after_data_and_another_order_is_noted(run: Run, old: bool) -> None:
    words = ["coulomb", "run1.csv"] if old else ["run1.csv", "coulomb"]
    for verb in ("fit", "compare"):
        code, out, err = run(verb, *words, "--json")
        assert code == 0 and json.loads(out)
        assert ("DATA stands before models: run1.csv coulomb" in err) == old
    assert ("note: DATA" in run("add", *words, "offset", "--json")[2]) == old


def test_a_model_is_an_argument_or_an_option(run: Run) -> None:
    by_option = json.loads(run("fit", "run1.csv", "--model", "coulomb+offset", "--json")[1])
    as_argument = json.loads(run("fit", "run1.csv", "coulomb+offset", "--json")[1])
    assert by_option["parameters"] == as_argument["parameters"]
    code, out, err = run("fit", "run1.csv", "coulomb", "--model", "lugre")
    assert (code, out) == (2, "") and "2 are given, one of them with --model: coulomb, lugre" in err
    # With a model by option, a word that is no file is a file that is missing.
    assert "nofile: no such file" in run("fit", "nofile", "--model", "coulomb")[2]


def test_errors_on_another_recording(run: Run) -> None:
    fitted = json.loads(run("fit", "run1.csv", "coulomb", "--evaluate", "other.csv", "--json")[1])
    (there,) = fitted["evaluated"]
    compared = json.loads(
        run(
            "compare", "run1.csv", "coulomb", "coulomb+offset", "--evaluate", "other.csv", "--json"
        )[1]
    )["evaluated"]
    assert [row["model"] for row in compared] == ["coulomb", "coulomb+offset"]
    assert compared[0]["rmse"] == there["rmse"] and there["file"] == "other.csv"
    added = run("add", "run1.csv", "coulomb", "offset", "--evaluate", "other.csv")[1]
    assert "On recordings that were not fitted" in added
    code, _, err = run("compare", "run1.csv", "coulomb", "--evaluate", "run1.csv")
    assert code == 2 and "the model is fitted to it" in err
    code, _, err = run("improve", "run1.csv", "coulomb", "--evaluate", "run1.csv")
    assert code == 2 and "the model is fitted to it" in err and "searching" not in err


def test_a_model_file_is_not_judged_where_it_was_fitted(run: Run) -> None:
    run("fit", "other.csv", "coulomb", "-o", "m.toml")
    code, _, err = run("compare", "run1.csv", "m.toml", "--evaluate", "other.csv")
    assert code == 2 and "the model is fitted to it" in err


def test_values_of_each_run_in_a_comparison(run: Run) -> None:
    words = ["compare", "run1.csv", "run2.csv", "coulomb", "coulomb+offset"]
    own = json.loads(run(*words, "--per-run", "t0", "--json")[1])["models"]
    shared = json.loads(run(*words, "--json")[1])["models"]
    assert own[0]["rmse"] == shared[0]["rmse"] and own[1]["rmse"] < shared[1]["rmse"]
    code, _, err = run(*words, "--per-run", "t0,ofset")
    assert code == 2 and "--per-run ofset: no model that is fitted has this parameter" in err


def test_a_value_that_a_project_holds_is_held_in_later_steps(run: Run) -> None:
    words = ["project", "new", "p.toml", "run1.csv", "run2.csv", "--fix", "a1=0.25", "--json"]
    assert json.loads(run(*words)[1])["data"]["path"] == "run1.csv and 1 more"
    assert run("project", "add", "p.toml", "offset")[0] == 0
    assert run("project", "save", "p.toml", "-o", "m.toml")[0] == 0
    held = json.loads(run("fit", "run1.csv", "m.toml", "--json")[1])["parameters"]
    assert held["viscous_friction"]["value"] == 0.25 and "offset" in held


def test_a_plan_takes_what_is_stated_about_parameters(run: Run) -> None:
    limits = ["--position", "-1:1", "--speed", "1", "--acceleration", "5", "--show", "offset"]
    code, _, err = run("plan", "run1.csv", "coulomb", "--fix", "a9=1", *limits)
    assert code == 2 and "has no parameter 'a9'" in err
    run("fit", "run1.csv", "coulomb", "-o", "m.toml")
    code, _, err = run("plan", "m.toml", "--fix", "a1=1", *limits)
    assert code == 2 and "name DATA too" in err


def test_a_fleet_takes_what_is_stated_about_parameters(run: Run) -> None:
    words = ["fleet", "run1.csv", "coulomb", "--workers", "1", "--name", "{robot}.csv", "--fix"]
    code, _, err = run(*words, "a1=0.25", "-o", "kept")
    assert code == 0, err
    code, _, err = run(*words, "a1=0.5", "-o", "kept")
    assert code == 2 and "with other bounds, starts or fixed values" in err
    code, _, err = run(*words, "a9=0.5", "-o", "new")
    assert code == 2 and "has no parameter 'a9'" in err


def test_a_study_judges_its_best_fits(run: Run) -> None:
    words = [
        "study",
        "run1.csv",
        "coulomb",
        "--workers",
        "1",
        "-o",
        "new",
        "--evaluate",
        "other.csv",
    ]
    code, out, err = run(*words, "--json")
    assert code == 0, err
    (row,) = json.loads(out)["evaluated"]
    assert row["model"] == "coulomb" and row["joint"] is None and row["rmse"] > 0.0

"""The workbench without a browser: actions change the state, and every page shows it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import StribeckError
from stribeck.report.workbench.controller import Workbench
from stribeck.report.workbench.figures import Drawn
from stribeck.report.workbench.forms import act, options_of, with_option
from stribeck.report.workbench.views import PAGES, page
from synthetic import joint

WAIT = 60.0


def link(path: str, **query: str) -> str:
    return f"/{path}?token=t"


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Workbench]:
    path = tmp_path / "joint.csv"
    joint(rows=1500).write_csv(path)
    made = Workbench(tmp_path / "kept", [str(path)])
    assert made.wait(WAIT)
    yield made
    made.cancel()


@pytest.fixture(scope="module")
def idle(tmp_path_factory: pytest.TempPathFactory) -> Workbench:
    """An open recording on which nothing is done."""
    folder = tmp_path_factory.mktemp("idle")
    joint(rows=1500).write_csv(folder / "joint.csv")
    made = Workbench(folder / "kept", [str(folder / "joint.csv")])
    assert made.wait(WAIT)
    return made


def do(bench: Workbench, action: str, **fields: str) -> None:
    act(bench, action, {name: [said] for name, said in fields.items()})
    assert bench.wait(WAIT)
    message = bench.state.message
    assert message is None or message.kind == "done", message


def shown(bench: Workbench) -> str:
    return "".join(page(bench, name, link) for name in PAGES)


def test_the_loop(bench: Workbench) -> None:
    assert "Fit this law" in shown(bench)
    do(bench, "start", law="coulomb")
    do(bench, "add", effect="offset")
    do(bench, "reject", effect="load", why="<b>known</b>")
    do(bench, "name", name="with offset")
    do(bench, "back", node="0")
    do(bench, "add", effect="inertia")
    do(bench, "compare", one="with offset", other="2")
    do(bench, "prove", box="velocity=-1:1")
    do(bench, "back", node="with offset")
    do(bench, "accept", effect="load")
    do(bench, "reject", effect="load", why="<b>known</b>")
    text = shown(bench)
    assert "&lt;b&gt;known" in text and "<b>known" not in text
    assert "coulomb+offset" in text
    drawn = Drawn(bench)
    for name in ("data", "where", "compare", "add"):
        answer = drawn.answer(name)
        assert json.loads(answer)["places"], name
        assert drawn.answer(name) is answer
        number = json.loads(answer)["number"]
        assert json.loads(drawn.answer(name, number)) == {"same": True}
        assert drawn.answer(name, number + "0") is answer
    window = drawn.window("where", 1.0, 2.0)
    assert set(window["time"]) == {"type", "content"}
    kept = sb.project(bench.project.path)
    assert [node.label for node in kept.tree] == ["coulomb", "+ offset", "+ inertia"]
    do(bench, "export", format="c", precision="f64")
    do(bench, "save model")
    assert {path.suffix for path in bench.state.written} >= {".toml", ".c", ".h"}


def test_a_project_is_opened_again(bench: Workbench, tmp_path: Path) -> None:
    do(bench, "start", law="coulomb")
    again = Workbench(tmp_path / "other", [str(bench.project.path)])
    assert again.wait(WAIT)
    assert again.project.node.kept.rmse == bench.project.node.kept.rmse
    assert again.joint.comparison is not None


def test_errors_are_the_sentence_of_the_command(bench: Workbench) -> None:
    act(bench, "start", {"law": ["cuolomb"]})
    assert bench.wait(WAIT)
    with pytest.raises(StribeckError) as error:
        sb.model("cuolomb")
    assert bench.state.message is not None
    assert bench.state.message.text == str(error.value)


@pytest.mark.parametrize(
    ("action", "fields", "said"),
    [
        ("nothing", {}, "no action"),
        ("diagnose", {}, "no law is fitted"),
        ("open", {"path": ["/nowhere.csv"]}, "no such file"),
        ("open", {}, "'path' is empty"),
        ("choose", {"number": ["7"]}, "no recording 7"),
        ("plan", {"lowest position": ["a"]}, "give a number"),
        ("prove", {}, "no law is fitted"),
    ],
)
def test_what_cannot_be_done(
    idle: Workbench, action: str, fields: dict[str, list[str]], said: str
) -> None:
    with pytest.raises(StribeckError, match=said):
        act(idle, action, fields)


def test_a_column_is_read_as_a_channel(tmp_path: Path) -> None:
    path = tmp_path / "joint.csv"
    joint(rows=1500).rename({"velocity": "speed of it"}).write_csv(path)
    bench = Workbench(tmp_path, [str(path)])
    assert bench.wait(WAIT)
    do(bench, "apply", option="map", value="velocity=speed of it")
    assert bench.joint.recording is not None
    assert bench.joint.recording.columns["velocity"].source == "speed of it"


@pytest.mark.slow
def test_several_files_are_runs_of_one_joint(tmp_path: Path) -> None:
    files = [str(tmp_path / f"run{k}.csv") for k in (1, 2)]
    for seed, path in enumerate(files):
        joint(rows=1500, seed=seed).write_csv(path)
    bench = Workbench(tmp_path / "kept", files)
    assert bench.wait(WAIT)
    assert bench.joint.recording is not None
    assert bench.joint.recording.run_names == ("run1", "run2")
    assert "runs of one joint" in page(bench, "data", link)
    do(bench, "start", law="coulomb")
    assert bench.project.node.kept.rmse == sb.fit("coulomb", sb.read(files)).rmse
    path = str(bench.project.path)
    # One of them alone is work of its own; the project opens with both files.
    do(bench, "open", path=files[1])
    assert bench.joint.recording.runs == 1
    again = Workbench(tmp_path / "other", [path])
    assert again.wait(WAIT)
    assert again.joint.recording is not None and again.joint.recording.runs == 2
    do(again, "start", law="coulomb+offset")
    assert len(again.project.source.files) == 2
    # By a pattern, by two paths, and ticked.
    do(bench, "open", path=str(tmp_path / "run*.csv"))
    assert bench.joint.files == tuple(files)
    do(bench, "open", path=" ".join(reversed(files)))
    assert bench.joint.files == tuple(reversed(files))
    act(bench, "open together", {"file": files})
    assert bench.wait(WAIT) and bench.joint.files == tuple(files)


def test_a_joint_is_chosen_of_a_file_with_several(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    parts = [
        joint(rows=1500, seed=k).select(
            "time",
            pl.col("position").alias(f"q_{k}"),
            pl.col("velocity").alias(f"dq_{k}"),
            pl.col("torque").alias(f"tau_{k}"),
        )
        for k in (1, 2)
    ]
    pl.concat([parts[0], parts[1].drop("time")], how="horizontal").write_csv(path)
    bench = Workbench(tmp_path, [str(path)])
    assert bench.wait(WAIT)
    assert bench.joint.others == ("1", "2") and bench.joint.recording is None
    assert "Joint 2" in page(bench, "data", link) and "stribeck robot" in page(bench, "data", link)
    do(bench, "apply", option="joint", value="2")
    assert bench.joint.recording is not None and bench.joint.options.joint == "2"
    assert bench.joint.others == ("1", "2")
    act(bench, "improve robot", {"robot": [str(tmp_path / "none.urdf")]})
    assert bench.wait(WAIT) and bench.state.message is not None
    assert "none.urdf" in bench.state.message.text and bench.state.message.kind == "error"


def test_work_is_stopped_at_once(bench: Workbench) -> None:
    do(bench, "start", law="coulomb")
    act(bench, "improve", {})
    bench.cancel()
    assert bench.wait(0.1)
    assert bench.project.node.label == "coulomb"


def test_what_is_sent_keeps_its_name_and_stays_in_the_folder(bench: Workbench) -> None:
    content = Path(bench.joint.files[0]).read_bytes()
    for _ in range(2):
        bench.upload([("../../outside.csv", content)])
        assert bench.wait(WAIT)
    sent = sorted((bench.folder / "uploads").iterdir())
    assert [path.name for path in sent] == ["outside-2.csv", "outside.csv"]
    with pytest.raises(StribeckError, match="format"):
        bench.upload([("run.exe", b"")])


def test_options_of_a_form() -> None:
    made = options_of({"joint": ["2"], "gear_ratio": ["50"], "map": ["time=t\nvelocity=w"]})
    assert (made.joint, made.gear_ratio, made.map) == ("2", 50.0, ("time=t", "velocity=w"))
    made = with_option(made, "map", "velocity=v2")
    assert made.pairs("map") == {"time": "t", "velocity": "v2"}
    assert with_option(made, "trust", "").trust

"""Random texts at every door: code 0 or 2, and never a sentence that is none."""

from __future__ import annotations

from pathlib import Path

import stribeck as sb
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hostile.contract import check_refused, check_sentence, nothing_written, run

#: The same inputs in every run.
FEW = settings(
    max_examples=25,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=60)
FORMULAS = st.text("cv123+-*/^(), .tanhexpabs=", max_size=40)
VALUES = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), TEXTS, st.binary())


def answered(folder: Path, *words: str) -> None:
    """Code 0, or a refusal."""
    with nothing_written(folder):
        answer = run(words)
        if answer.code:
            check_refused(answer)


@FEW
@given(spec=TEXTS)
def test_specs(workspace: Path, spec: str) -> None:
    answered(workspace, "fit", "log.csv", f"--model={spec}", "--starts", "1")


@FEW
@given(formula=FORMULAS)
def test_formulas(workspace: Path, formula: str) -> None:
    answered(workspace, "fit", "log.csv", f"--law={formula}", "--starts", "1")


@FEW
@given(value=TEXTS, flag=st.sampled_from(["--bound", "--fix", "--prior", "--tie", "--map"]))
def test_flags(workspace: Path, value: str, flag: str) -> None:
    answered(workspace, "fit", "log.csv", "--model", "coulomb", f"{flag}={value}")


@FEW
@given(line=TEXTS, name=st.sampled_from(["m.toml", "p.toml", "log.csv.sidecar.toml"]))
def test_files(workspace: Path, line: str, name: str) -> None:
    words = {
        "m.toml": ("compare", "log.csv", "m.toml"),
        "p.toml": ("project", "show", "p.toml"),
        "log.csv.sidecar.toml": ("inspect", "log.csv"),
    }
    path = workspace / name
    good = path.read_bytes()
    try:
        path.write_bytes(line.encode() + b"\n" + good)
        answered(workspace, *words[name])
    finally:
        path.write_bytes(good)


@FEW
@given(value=VALUES)
def test_arguments_of_python(value: object) -> None:
    model = sb.model("coulomb", coulomb_friction=1.0, viscous_friction=1.0)
    for call in (
        lambda: sb.model("coulomb", coulomb_friction=value),
        lambda: sb.model(value),
        lambda: model.torque(value),
        lambda: sb.check(model, box={"velocity": value}),
        lambda: sb.Joint(value),
    ):
        try:
            call()
        except sb.StribeckError as error:
            check_sentence(str(error))

"""`stribeck generate`: synthetic recordings with chosen hidden effects."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
import polars as pl

from stribeck.cli.common import check_output, echo_json, json_option, seed_option
from stribeck.errors import SpecError
from stribeck.generate import JOINTS, file_bytes, sidecar_text
from stribeck.generate import generate as make
from stribeck.model_file import write_whole
from stribeck.report.figures import write_bytes_whole
from stribeck.report.numbers import plain
from stribeck.report.text import table, unit_text


@click.command()
@click.option(
    "-o", "--output", required=True, type=click.Path(dir_okay=False),
    help="The recording: .parquet or .csv.",
)  # fmt: skip
@click.option(
    "--effect", "effects", multiple=True, metavar="EFFECT",
    help="Hide this effect; may be given several times (`stribeck effects` lists them).",
)  # fmt: skip
@click.option("--law", default="coulomb", show_default=True, help="The friction law beneath.")
@click.option("--seconds", default=120.0, show_default=True, help="Duration, s.")
@click.option("--rate", default=200.0, show_default=True, help="Samples a second, Hz.")
@click.option(
    "--noise", default=0.02, show_default=True,
    help="RMS of the torque noise as a share of Coulomb friction.",
)  # fmt: skip
@click.option("--warming", default=20.0, show_default=True, help="Warm-up of the joint, K.")
@click.option("--joint-kind", default="revolute", show_default=True, type=click.Choice([*JOINTS]))
@seed_option
@json_option
def generate(
    output: str, effects: tuple[str, ...], law: str, seconds: float, rate: float, noise: float,
    warming: float, joint_kind: str, seed: int, as_json: bool,
) -> None:  # fmt: skip
    """Make a synthetic recording with hidden effects.

    Beside the recording stand its sidecar (joint kind) and what is hidden in it (.truth.json).
    """
    target = Path(output)
    if target.suffix.lower() not in (".parquet", ".csv"):
        raise SpecError(f"cannot write {output}: its name must end in .parquet or .csv")
    if seed < 0:
        raise SpecError(f"seed {seed} is negative: give 0 or more")
    check_output(output)
    frame, truth = make(
        effects, law=law, seed=seed, seconds=seconds, rate=rate, noise=noise,
        joint_kind=joint_kind, warming=warming,
    )  # fmt: skip
    truth_path = target.with_name(f"{target.name}.truth.json")
    sidecar_path = target.with_name(f"{target.name}.sidecar.toml")
    write_bytes_whole(target, file_bytes(frame, target.suffix.lower()))
    write_whole(truth_path, json.dumps(truth, indent=2) + "\n")
    write_whole(sidecar_path, sidecar_text(truth))
    if as_json:
        echo_json(
            {
                "path": str(target), "truth_path": str(truth_path),
                "sidecar_path": str(sidecar_path), "rows": frame.height, **truth,
            }
        )  # fmt: skip
    else:
        click.echo(_text(target, truth_path, frame, truth))


def _text(path: Path, truth_path: Path, frame: pl.DataFrame, truth: dict[str, Any]) -> str:
    unit = truth["torque_unit"]
    rows = [["parameter", "value", "unit"]]
    rows += [
        [name, plain(p["value"], 4), unit_text(p["unit"])]
        for name, p in truth["parameters"].items()
    ]
    hidden = ", ".join(truth["hidden"]) or "nothing"
    return "\n".join(
        [
            f"wrote {path}: {frame.height} rows, {plain(truth['seconds'])} s at "
            f"{plain(truth['rate_hz'])} Hz, {truth['joint_kind']} joint",
            "",
            f"  hidden in it: {hidden} (friction is {truth['spec']})",
            f"  torque noise: {plain(truth['noise_rms'])} {unit} RMS, seed {truth['seed']}",
            "",
            table(rows, right=(1,)),
            "",
            f"The truth is in {truth_path}. Now try:",
            f"  stribeck improve {path} --base {truth['law']}",
        ]
    )

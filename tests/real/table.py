"""Print the table of real measurements of docs/results.md, from running the commands it names.

python tests/real/table.py          # needs ../shared/data
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

DATA = "../shared/data"
RECORDINGS = (
    ("EMPS ball-screw drive", "emps/emps.parquet", "emps"),
    ("UR10e joint 1", "ur10e/ur-20_01_22-joint_1.parquet", "ur10e_joint_1"),
    ("UR10e joint 2", "ur10e/ur-20_01_22-joint_2.parquet", "ur10e_joint_2"),
    ("UR10e joint 3", "ur10e/ur-20_01_22-joint_3.parquet", "ur10e_joint_3"),
    ("XL330 servo and pendulum", "bam_xl330/xl330_pendulum.parquet", "bam_xl330"),
    ("lead screw, steady speeds", "screwdrives/screwdrives.parquet", "screwdrives_drive_1"),
    ("worm drive, steady speeds", "screwdrives/screwdrives.parquet", "screwdrives_drive_3"),
)


def stribeck(*words: str) -> dict:
    """The JSON that a command prints."""
    command = [sys.executable, "-m", "stribeck", *words, "--json"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def percent(value: float | None) -> str:
    """A share in per cent."""
    return "" if value is None else f"{100 * value:.1f} %"


def main() -> None:
    """Run every recording and print the table, then the commands."""
    findings = "effects found, in this order, with confidence (indistinguishable from)"
    print(f"| recording | {findings} | held-out RMSE | relative residual |")
    print("|---|---|---|---|")
    commands = []
    for name, file, sidecar in RECORDINGS:
        words = ["improve", f"{DATA}/{file}", "--sidecar", f"tests/sidecars/{sidecar}.sidecar.toml"]
        commands.append("stribeck " + " ".join(words))
        got = stribeck(*words)
        found = []
        for step in got["steps"]:
            tied = step["indistinguishable_from"]
            sure = "> 0.99" if step["confidence"] > 0.99 else f"{step['confidence']:.2f}"
            found.append(f"{step['effect']} {sure}" + (f" ({', '.join(tied)})" if tied else ""))
        errors = [got["rmse_held_out_base"], *(s["rmse_held_out_after"] for s in got["steps"])]
        print(
            f"| {name} | {', then '.join(found) or 'none'} | "
            f"{' → '.join(f'{e:.3g}' for e in errors)} {got['unit']} | "
            f"{percent(got['relative_residual_base'])} → "
            f"{percent(got['final']['relative_residual'])} |",
            flush=True,
        )
    sidecar = ["--sidecar", "tests/sidecars/emps.sidecar.toml"]
    words = ["fit", f"{DATA}/emps/emps.parquet", *sidecar, "--model", "coulomb+offset"]
    fitted = stribeck(*words)
    commands.append("stribeck " + " ".join(words))
    print("\n`coulomb+offset` on EMPS: ", end="")
    print(
        ", ".join(
            f"{name} {p['value']:.4g} ± {p['stderr']:.2g} {p['unit']}"
            for name, p in fitted["parameters"].items()
        )
    )
    pulses = f"{DATA}/emps/emps_pulses.parquet"
    with tempfile.TemporaryDirectory() as folder:
        errors = {}
        for spec in ("coulomb", "coulomb+direction"):
            model = f"{folder}/model.toml"
            stribeck("fit", f"{DATA}/emps/emps.parquet", *sidecar, "--model", spec, "-o", model)
            other = ["--sidecar", "tests/sidecars/emps_pulses.sidecar.toml"]
            compared = stribeck("compare", pulses, *other, model)["models"][0]
            errors[spec] = compared["rmse_held_out"]
    print(
        "\nFitted on EMPS, error on its second file, with force pulses, never fitted to: "
        + ", ".join(f"`{spec}` {error:.3g} N" for spec, error in errors.items())
    )
    print("\n```console")
    print("\n".join(commands))
    print("```")


if __name__ == "__main__":
    main()

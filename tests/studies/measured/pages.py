"""Pages of the documentation on published measurements: what the loop finds in them.

python tests/studies/measured/pages.py DATA FOLDER

DATA is the folder of the data sets. Writes the pages, their pictures, and the report of each
recording into FOLDER.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import stribeck as sb
from stribeck.cli.pages import proof
from stribeck.report.diagnosis import (
    carried_sentence,
    doubts,
    indistinguishable_sentence,
    untestable_rows,
)
from stribeck.report.improvement import stopped_sentence, summary_sentence
from stribeck.report.numbers import change_text, confidence_words, percent, plain
from stribeck.report.pages.account import of_improvement
from stribeck.report.pages.recording import account_page
from stribeck.report.parameters import parameter_rows
from stribeck.report.unexplained import left_text

SIDECARS = Path(__file__).resolve().parents[2] / "sidecars"
#: Janot, Gautier and Brunot 2019: IDIM-LS on this recording, in the units of the recording.
PUBLISHED_EMPS = {
    "inertia": 95.1,
    "viscous_friction": 203.5,
    "coulomb_friction": 20.4,
    "offset": -3.2,
}
DPI = 100


@dataclass(frozen=True)
class Measured:
    """A recording: its heading, its file below the data, and the name of its sidecar."""

    title: str
    file: str
    sidecar: str

    @property
    def command(self) -> str:
        """What is run, from a checkout that has the data beside it."""
        return (
            f"stribeck improve ../shared/data/{self.file} "
            f"--sidecar tests/sidecars/{self.sidecar}.sidecar.toml"
        )

    def read(self, data: Path) -> sb.Recording:
        """The recording."""
        return sb.read(data / self.file, sidecar=SIDECARS / f"{self.sidecar}.sidecar.toml")


EMPS = Measured("EMPS", "emps/emps.parquet", "emps")
PULSES = Measured("EMPS with pulses", "emps/emps_pulses.parquet", "emps_pulses")
UR10E = [
    Measured(f"Joint {k}", f"ur10e/ur-20_01_22-joint_{k}.parquet", f"ur10e_joint_{k}")
    for k in (1, 2, 3)
]


def main() -> None:
    """Write both pages."""
    data, folder = map(Path, sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "emps.md").write_text(emps(data, folder), encoding="utf-8")
    (folder / "ur10e.md").write_text(ur10e(data, folder), encoding="utf-8")


def emps(data: Path, folder: Path) -> str:
    """The page on the electro-mechanical positioning system."""
    recording = EMPS.read(data)
    ordinary = sb.fit("coulomb+offset", recording)
    found = sb.improve("coulomb", recording)
    other = PULSES.read(data)
    errors = [sb.evaluate(fit.model, other).rmse for fit in (found.base, ordinary, found.final)]
    known = [ordinary.estimates[name] for name in PUBLISHED_EMPS]
    rows = [
        [f"`{name}`", f"{PUBLISHED_EMPS[name]:g}", f"{value} {error}", unit]
        for name, _, value, error, unit, *_ in parameter_rows(known)
    ]
    specs = [fit.model.spec for fit in (found.base, ordinary, found.final)]
    return "\n".join(
        [
            "# A cart on a screw: EMPS",
            "",
            "The electro-mechanical positioning system is a cart on a ball screw, under feedback, "
            "24.8 s at 1 kHz (Janot, Gautier and Brunot 2019; Apache-2.0). Position and motor "
            f"force are recorded. {made_by_code()}",
            "",
            "## What its authors identify",
            "",
            "Mass, viscous and Coulomb friction and an offset, `coulomb+offset`:",
            "",
            *table(["parameter", "published", "here", "unit"], rows),
            "",
            *section(EMPS, found, folder),
            "## The second file",
            "",
            "It has force pulses, and nothing was fitted to it or chosen on it.",
            "",
            *table(
                ["model", "error (RMSE) on the second file"],
                [[f"`{s}`", f"{plain(e)} N"] for s, e in zip(specs, errors, strict=True)],
            ),
            "",
            "As a notebook: [the EMPS benchmark](../tutorials.md).",
            "",
        ]
    )


def ur10e(data: Path, folder: Path) -> str:
    """The page on three joints of a robot."""
    parts = [
        "# A robot arm: UR10e",
        "",
        "One joint moves at a time, 60 to 80 s at 100 Hz (Mamedov and others; MIT). Torque is the "
        "motor current times the drive gain of the joint. Inertia and gravity are identified "
        "together with the friction. Each file begins with an approach move and ends in an abrupt "
        f"stop: these are scored, but excluded from the fits. {made_by_code()} "
        "[Whole robots](../robots.md) has the same arm with all joints moving.",
        "",
    ]
    for joint in UR10E:
        parts += section(joint, sb.improve("coulomb", joint.read(data)), folder)
    return "\n".join(parts)


def made_by_code() -> str:
    """How the page came about."""
    return (
        "This page is made when the documentation is built, by the commands on it, where the data "
        "set lies beside the checkout."
    )


def section(of: Measured, found: sb.Improvement, folder: Path) -> list[str]:
    """What the loop finds in a recording."""
    name = of.sidecar
    fits = [found.base, *(step.after for step in found.steps)]
    account = of_improvement(found, sb.compare(fits, found.final.recording))
    page = account_page(account.made_by(of.command, proof(found.final)))
    (folder / f"{name}.report.html").write_text(page, encoding="utf-8")
    lines = [
        "## What the loop adds" if of is EMPS else f"## {of.title}",
        "",
        "```console",
        of.command,
        "```",
        "",
        summary_sentence(found),
        "",
        picture(found.plot(), folder, f"{name}.png", f"Torque, residual and error of {of.title}"),
        "",
        *table(["step", "effect", "confidence", "held-out error", "change"], steps(found)),
        "",
    ]
    for step in found.steps:
        finding = step.finding
        alt = f"Residual of {of.title} without and with {finding.effect}"
        file = f"{name}_{finding.effect}.png"
        lines += [
            f"**[{finding.effect}](../effects.md#{finding.effect})**: {finding.where}. "
            f"{share(finding)}{carried_sentence(finding)}"
            f" {indistinguishable_sentence(finding) if finding.indistinguishable_from else ''}",
            "",
            picture(finding.plot(), folder, file, alt),
            "",
        ]
    lines += [
        f"{stopped_sentence(found)} {left_text(found.unexplained, found.final.recording)}",
        "",
    ]
    for heading, rows in doubts(found.last):
        lines += [f"{heading}:", "", *(f"- {row}" for row in rows), ""]
    return [*lines, *details(found, name)]


def details(found: sb.Improvement, name: str) -> list[str]:
    """Parameters, what cannot be tested, and the report."""
    heading = ["parameter", "symbol", "value", "standard error", "unit", "relative", "remark"]
    parameters = [
        [f"`{row[0]}`", *row[1:]] for row in parameter_rows(found.final.estimates.values())
    ]
    return [
        f"Parameters of `{found.final.model.spec}`:",
        "",
        *table(heading, parameters),
        "",
        "Cannot be tested with this recording:",
        "",
        *table(["effect", "why", "to test it"], untestable_rows(found.untestable)),
        "",
        f"[The whole report, with figures to zoom and select in]({name}.report.html)",
        "",
    ]


def steps(found: sb.Improvement) -> list[list[str]]:
    """The rows of the base and of each added effect."""
    unit, before = found.final.model.torque_unit, found.base.rmse_held_out
    rows = [["", f"`{found.base.model.spec}`", "", f"{plain(before)} {unit}", ""]]
    for number, step in enumerate(found.steps, 1):
        after = step.after.rmse_held_out
        rows.append(
            [
                f"{number}",
                f"`{step.finding.effect}`",
                confidence_words(step.finding.confidence),
                f"{plain(after)} {unit}",
                change_text(before, after),
            ]
        )
        before = after
    return rows


def share(finding: sb.Finding) -> str:
    """How much of the unexplained error a finding explains."""
    of = finding.share_of_unexplained
    return "" if of is None else f"It explains {percent(of)} of what was above the noise floor. "


def picture(figure: object, folder: Path, name: str, alt: str) -> str:
    """Write a figure; returns what shows it."""
    figure.savefig(folder / name, dpi=DPI)  # type: ignore[attr-defined]
    return f"[![{alt}]({name})]({name})"


def table(heading: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A table of a page."""
    return [
        f"| {' | '.join(heading)} |",
        f"|{'---|' * len(heading)}",
        *(f"| {' | '.join(cell.replace('|', '&#124;') for cell in row)} |" for row in rows),
    ]


if __name__ == "__main__":
    main()

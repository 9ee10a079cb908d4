"""Are findings among nuisances right as often as their confidence says? Tables and a figure.

python tests/studies/reliability.py ANSWERS.jsonl...

Reads the answers of `stribeck benchmark diagnosis --realism N -o FOLDER`, of one run or of several,
and prints their statistics as the command does. Writes the figure of docs/nuisances.md, and beside
this script its data: one row for each finding.
"""

from __future__ import annotations

import sys
from pathlib import Path

import polars as pl
from stribeck.base.files import save_figure, write_whole
from stribeck.benchmark.figures import calibration_figure
from stribeck.benchmark.reliability import judged_findings
from stribeck.benchmark.score import score
from stribeck.benchmark.store import read_answers
from stribeck.benchmark.text import score_text

DATA = Path(__file__).with_suffix(".csv")
PICTURE = Path(__file__).resolve().parents[2] / "docs" / "confidence.png"


def main() -> None:
    answers = [answer for name in sys.argv[1:] for answer in read_answers(Path(name))]
    made = score(answers)
    print(score_text(made))
    rows = [
        {"recording": f.recording, "confidence": round(f.confidence, 4), "right": f.right}
        for f in judged_findings(answers)
    ]
    write_whole(DATA, pl.DataFrame(rows).write_csv())
    save_figure(calibration_figure(made.reliability), PICTURE)


if __name__ == "__main__":
    main()

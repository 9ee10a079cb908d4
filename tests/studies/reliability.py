"""Are findings among nuisances right as often as their confidence says? Tables and a figure.

python tests/studies/reliability.py [ANSWERS.jsonl...]

Reads the answers of `stribeck benchmark diagnosis --realism N -o FOLDER`, of one run or of several,
and prints their statistics as the command does. Without a file it reads those beside this script:
seeds that were run once, before any rule was made from them. Writes the figure of
docs/nuisances.md.
"""

from __future__ import annotations

import sys
from pathlib import Path

from stribeck.base.files import save_figure
from stribeck.benchmark.figures import calibration_figure
from stribeck.benchmark.score import score
from stribeck.benchmark.store import read_answers
from stribeck.benchmark.text import score_text

KEPT = Path(__file__).with_suffix("")
PICTURE = Path(__file__).resolve().parents[2] / "docs" / "confidence.png"


def main() -> None:
    files = [Path(name) for name in sys.argv[1:]] or sorted(KEPT.glob("*.jsonl"))
    made = score([answer for path in files for answer in read_answers(path)])
    print(score_text(made))
    save_figure(calibration_figure(made.reliability), PICTURE)


if __name__ == "__main__":
    main()

"""Time of fits with as many threads as the environment says, or in as many processes as asked.

python benches/scaling/side_by_side.py threads|processes COUNT
"""

from __future__ import annotations

import sys
from time import perf_counter

import motions
import stribeck as sb
from curves import JOINTS, MIDDLE
from stribeck.parallel import in_processes

LAW = "lugre"
STARTS = 20
#: Of each joint's fit, where there are many.
FEW_STARTS = 4


def fit_of_one(recording: sb.Recording) -> float:
    """The error of one joint's fit."""
    return sb.fit(LAW, recording, starts=FEW_STARTS).rmse


def main() -> None:
    """Print seconds."""
    task, count = sys.argv[1], int(sys.argv[2])
    recording = motions.recording(LAW, MIDDLE)
    errors: list[float] = []
    begin = perf_counter()
    if task == "threads":
        sb.fit(LAW, recording, starts=STARTS)
    else:
        in_processes(fit_of_one, [recording] * JOINTS, errors.append, count)
    print(perf_counter() - begin)


if __name__ == "__main__":
    main()

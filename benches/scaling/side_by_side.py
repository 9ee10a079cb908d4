"""Time of fits with as many threads as the environment says, or in as many processes as asked.

python benches/scaling/side_by_side.py threads|processes|counting COUNT

Counting needs no memory and shares nothing: how it gains is what the machine has to give just then.
"""

from __future__ import annotations

import sys
from time import perf_counter

import motions
import stribeck as sb
from curves import JOINTS, MIDDLE
from stribeck.base.pool import ProcessPool, run_each

LAW = "lugre"
STARTS = 20
#: Of each joint's fit, where there are many.
FEW_STARTS = 4
#: As long as a fit.
COUNTED = 30_000_000


def fit_of_one(recording: sb.Recording) -> float:
    """The error of one joint's fit."""
    return sb.fit(LAW, recording, starts=FEW_STARTS).rmse


def counting(_: sb.Recording) -> float:
    """As much work, without any memory."""
    return float(sum(1 for _ in range(COUNTED)))


def main() -> None:
    """Print seconds."""
    task, count = sys.argv[1], int(sys.argv[2])
    recording = motions.recording(LAW, MIDDLE)
    answers: list[float] = []
    begin = perf_counter()
    if task == "threads":
        sb.fit(LAW, recording, starts=STARTS)
    else:
        do = counting if task == "counting" else fit_of_one
        with ProcessPool(count) as pool:
            run_each(do, [recording] * JOINTS, answers.append, pool)
    print(perf_counter() - begin)


if __name__ == "__main__":
    main()

"""Which algorithm finds the best known minima of the UR5e study, and how long it takes.

    python benches/search/algorithms.py                     all algorithms, motion 1
    python benches/search/algorithms.py slsqp lbfgs         some of them

Each algorithm searches the same fits from the same starts: those of motion 1 with at least one
nonlinear parameter. All end with Gauss-Newton steps on all samples, as in a fit. Algorithms of the
whole range take as many evaluations as all starts together may. The default of a fit is the first
row; hops to better minima nearby and a second round of starts belong to it and are left out in the
second row, which compares the searches alone.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import replace

import stribeck.identify.search.many_starts as search
from optima import CLOSE, FOLDER, TABLE
from problems import Case, cases, error_of, found, problem_of
from stribeck.identify.search.algorithms import ALGORITHMS, GAUSS_NEWTON, MOST_OF_AGS
from stribeck.identify.search.effort import THOROUGH

#: The row of the default without hops and a second round of starts.
ALONE = f"{GAUSS_NEWTON}, alone"


def main() -> None:
    """Print one row an algorithm."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("algorithms", nargs="*", default=list(ALGORITHMS))
    parser.add_argument("--joints", nargs="+", default=["base", "elbow", "wrist_2"])
    options = parser.parse_args()
    chosen = [case for case in cases(motions=(1,)) if case.joint in options.joints]
    chosen = [case for case in chosen if searched(case)]
    known = json.loads(TABLE.read_text())
    print(f"{len(chosen)} fits, 20 starts\n")
    print(f"{'algorithm':<22}{'found':>7}{'CPU, s':>9}{'evaluations':>13}")
    for name in rows(options.algorithms):
        print(row(name, chosen, known), flush=True)


def rows(algorithms: list[str]) -> Iterator[str]:
    """The names of the rows."""
    yield GAUSS_NEWTON
    yield ALONE
    yield from (name for name in algorithms if name != GAUSS_NEWTON)


def searched(case: Case) -> bool:
    """Whether a case has a nonlinear parameter."""
    return any(not p.linear for p in problem_of(FOLDER, case).model.parameters)


def row(name: str, chosen: list[Case], known: dict[str, float]) -> str:
    """The minima that an algorithm finds, its time and its evaluations."""
    effort = replace(THOROUGH, algorithm=GAUSS_NEWTON if name == ALONE else name)
    hopping = search.HOPPING
    search.HOPPING = 1000 if name == ALONE else hopping
    reached, count, evaluations, seconds = 0, 0, 0, 0.0
    for case in chosen:
        problem = problem_of(FOLDER, case)
        nonlinear = sum(not p.linear for p in problem.model.parameters)
        if name == "ags" and nonlinear > MOST_OF_AGS:
            continue
        began = time.process_time()
        result = found(FOLDER, case, effort, starts=20, seed=0)
        seconds += time.process_time() - began
        error = error_of(FOLDER, case, result.search.square)
        reached += error <= (1.0 + CLOSE) * known[case.name]
        evaluations += result.evaluations
        count += 1
    search.HOPPING = hopping
    return f"{name:<22}{f'{reached}/{count}':>7}{seconds:>9.1f}{evaluations:>13}"


if __name__ == "__main__":
    main()

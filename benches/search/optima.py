"""How often the search of a fit finds the best known minimum of the UR5e study's 300 fits.

    python benches/search/optima.py                  score seed 0
    python benches/search/optima.py --seeds 0 1 2    score several seeds
    python benches/search/optima.py --search 500     search better minima from 500 starts, with
                                                     nlopt's MLSL beside them; keeps the best

The best known minima are in optima.json: the RMSE over the fitted samples. A fit counts as found if
its RMSE is at most a thousandth higher. The recordings are made by `stribeck generate` in
target/search.
"""

from __future__ import annotations

import argparse
import json
import time
from collections import defaultdict
from dataclasses import replace
from pathlib import Path

from problems import Case, cases, error_of, found
from stribeck.identify.search.effort import THOROUGH

FOLDER = Path(__file__).resolve().parents[2] / "target" / "search"
TABLE = Path(__file__).with_name("optima.json")
#: A fit is at the minimum if its RMSE is at most so much higher.
CLOSE = 1e-3


def main() -> None:
    """Score the search, or search better minima."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[0])
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--search", type=int, metavar="STARTS")
    parser.add_argument("--motions", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--laws", nargs="+")
    options = parser.parse_args()
    chosen = {"motions": tuple(options.motions)}
    if options.laws:
        chosen["laws"] = tuple(options.laws)
    known = json.loads(TABLE.read_text()) if TABLE.exists() else {}
    if options.search:
        for case in cases(**chosen):
            improve(case, known, options.search)
        return
    for seed in options.seeds:
        score(list(cases(**chosen)), known, options.starts, seed)


def improve(case: Case, known: dict[str, float], starts: int) -> None:
    """Replace the best known minimum of a case if a heavy search finds a better one."""
    heavy = replace(THOROUGH, finished=5)
    searches = [(heavy, starts, 1)]
    searches.append((replace(heavy, algorithm="mlsl", evaluations=100), starts // 10, 1))
    for effort, count, seed in searches:
        result = found(FOLDER, case, effort, starts=count, seed=seed)
        keep(case, known, error_of(FOLDER, case, result.search.square))


def keep(case: Case, known: dict[str, float], error: float) -> None:
    """Keep an error that is lower than the best known one."""
    before = known.get(case.name)
    if before is None or error < before * (1.0 - 1e-9):
        print(f"{case.name}: {error:.6g}" + ("" if before is None else f" (before {before:.6g})"))
        known[case.name] = error
        TABLE.write_text(json.dumps(dict(sorted(known.items())), indent=1) + "\n")


def score(chosen: list[Case], known: dict[str, float], starts: int, seed: int) -> None:
    """Print how many fits are at the best known minimum, and the others."""
    reached, seconds = 0, defaultdict(float)
    for case in chosen:
        began = time.perf_counter()
        result = found(FOLDER, case, THOROUGH, starts=starts, seed=seed)
        seconds[case.law] += time.perf_counter() - began
        error = error_of(FOLDER, case, result.search.square)
        keep(case, known, error)
        share = error / known[case.name] - 1.0
        reached += share <= CLOSE
        if share > CLOSE:
            print(
                f"{case.name}: RMSE {error:.6g} is {100 * share:.2f} % above {known[case.name]:.6g}"
            )
    slowest = sorted(seconds.items(), key=lambda pair: -pair[1])[:5]
    print(f"seed {seed}: {reached} of {len(chosen)} at the best known minimum")
    print(f"{sum(seconds.values()):.0f} s; " + ", ".join(f"{law} {s:.0f} s" for law, s in slowest))


if __name__ == "__main__":
    main()

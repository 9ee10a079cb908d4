"""One line a case: what the loop answers on recordings with a hidden effect.

    python tests/hidden/scoreboard.py [--seeds N] [--only WORD] [--quick] [--keep DIR]

`--only` takes an effect, a group (single, pair, none, limit, closed) or part of a case's name.
`--keep` leaves the recordings and the answers there.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import cases as hidden


def main() -> int:
    """Run the cases, print the table and the summary; 0 when every case passes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3, help="recordings for every single effect")
    parser.add_argument("--only", help="an effect, a group, a limit, or part of a name")
    parser.add_argument("--quick", action="store_true", help="the subset the tests run by default")
    parser.add_argument("--keep", type=Path, help="leave recordings and answers in this folder")
    options = parser.parse_args()

    import stribeck as sb

    chosen = [c for c in hidden.cases(options.seeds) if c.quick or not options.quick]
    if options.only:
        word = options.only
        exact = [c for c in chosen if word == c.group or c.effects == (word,)]
        chosen = exact or [c for c in chosen if word in c.name]
    folder = options.keep or Path(tempfile.mkdtemp(prefix="hidden-"))
    folder.mkdir(parents=True, exist_ok=True)
    groups: dict[str, list[bool]] = {}
    print(f"{'case':44} {'size':>5} {'':4} {'found':40} {'unt.':4} {'rmse/noise':>10} {'s':>6}")
    for case in chosen:
        frame, truth = case.make()
        path = folder / f"{case.name}.parquet"
        frame.write_parquet(path)
        begin = time.perf_counter()
        try:
            answer = sb.improve("coulomb", sb.read(path)).to_dict()
            verdict = hidden.judge(truth, answer)
        except Exception as failure:  # the table goes on; the line says what broke
            print(f"{case.name:44} {truth['size']:5.2f} FAIL {type(failure).__name__}: {failure}")
            groups.setdefault(case.group, []).append(False)
            continue
        seconds = time.perf_counter() - begin
        groups.setdefault(case.group, []).append(verdict.passed)
        print(
            f"{case.name:44} {truth['size']:5.2f} {'ok' if verdict.passed else 'FAIL':4} "
            f"{', '.join(verdict.found) or '-':40} {'ok' if verdict.untestable_ok else 'NO':4} "
            f"{verdict.ratio:10.3f} {seconds:6.1f}"
        )
        for problem in verdict.problems:
            print(f"{'':10}{problem}")
        sys.stdout.flush()
        if options.keep:
            record = {"truth": truth, "answer": answer, "problems": verdict.problems}
            path.with_suffix(".json").write_text(json.dumps(record, indent=1))
        else:
            path.unlink()
    print()
    for group, passed in groups.items():
        print(f"{group:8} {sum(passed):3d} of {len(passed):3d}")
    every = [p for passed in groups.values() for p in passed]
    print(f"{'all':8} {sum(every):3d} of {len(every):3d}")
    return 0 if every and all(every) else 1


if __name__ == "__main__":
    sys.exit(main())

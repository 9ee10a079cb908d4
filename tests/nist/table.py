"""Print how many of NIST's certified digits a law by formula reaches, from either start.

python tests/nist/table.py                # all sets, as any fit: 20 starts about the given one
python tests/nist/table.py --starts 1     # the given start alone
python tests/nist/table.py MGH10 Nelson   # some sets
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import stribeck as sb

sys.path.insert(0, str(Path(__file__).resolve().parent))

import sets


def main() -> int:
    """Print the table; 1 if a set falls short."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", metavar="SET")
    parser.add_argument("--starts", type=int, default=20)
    said = parser.parse_args()
    if not sets.FOLDER.is_dir():
        print(f"the data sets are not at {sets.FOLDER}", file=sys.stderr)
        return 2
    print("| set | start | digits of parameters | of standard errors | evaluations | seconds |")
    print("|---|---|---|---|---|---|")
    short = []
    with tempfile.TemporaryDirectory() as folder:
        for name in said.names or sets.names():
            known = sets.read(name)
            recording = sb.read(known.write(Path(folder)), **known.reading)
            for k, start in enumerate(known.starts, start=1):
                began = time.perf_counter()
                fitted = sb.fit(
                    known.law, recording, start=start, errors="independent", starts=said.starts
                )
                seconds = time.perf_counter() - began
                found = fitted.estimates
                values = known.digits({n: e.value for n, e in found.items()}, known.values)
                errors = known.digits({n: e.stderr for n, e in found.items()}, known.errors)
                if values < sets.PARAMETER_DIGITS or errors < known.error_digits:
                    short.append(f"{name} from start {k}")
                print(
                    f"| {name} | {k} | {values:.1f} | {errors:.1f} | {fitted.evaluations} | "
                    f"{seconds:.2f} |",
                    flush=True,
                )
    print(f"\nFalling short: {', '.join(short) or 'none'}.")
    return 1 if short else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Change the sources one operator at a time; the tests must notice.

    python3 develop.py mutants                             # 30 of each area, drawn by seed 1
    python3 develop.py mutants --share 0.2 --seed 2        # a fifth of all changes
    python3 develop.py mutants rust --area scalar
    python3 develop.py mutants python --area covariance --area transients

Exit code 1 if the tests catch less than nine tenths of the changes that are not equivalent.
"""

from __future__ import annotations

import argparse

import crate
import package
from mutant import Sample, report

LANGUAGES = {
    "rust": (crate.test, tuple(crate.TESTS)),
    "python": (package.test, tuple(package.AREAS)),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("language", nargs="*", choices=LANGUAGES, default=list(LANGUAGES))
    parser.add_argument("--area", action="append", help="only this one; may be repeated")
    parser.add_argument("--share", type=float, default=0.0, help="of the changes of each area")
    parser.add_argument("--fewest", type=int, default=30, help="changes of each area")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    enough = True
    for language in given.language:
        test, areas = LANGUAGES[language]
        areas = tuple(a for a in areas if given.area is None or a in given.area)
        results = test(Sample(given.share, given.fewest, given.seed), areas)
        enough = report(results, language) and enough
    raise SystemExit(0 if enough else 1)


if __name__ == "__main__":
    main()

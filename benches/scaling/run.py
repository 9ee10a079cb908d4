"""How times grow: over samples, parameters, threads and processes; tables and a picture.

python benches/scaling/run.py -o PICTURE.png
"""

from __future__ import annotations

import argparse
from pathlib import Path

from curves import Curve, over_parameters, over_samples, over_threads
from figure import drawn


def print_table(of: str, unit: str, curves: list[Curve]) -> None:
    """One row a curve; all are over the same numbers."""
    print(f"| {unit} | " + " | ".join(f"{number:,} {of}" for number in curves[0].at) + " |")
    print("|---" * (len(curves[0].at) + 1) + "|")
    for curve in curves:
        print(f"| {curve.name} | " + " | ".join(f"{time:.3g}" for time in curve.time) + " |")
    print()


def main() -> None:
    """Measure, print, draw."""
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", dest="picture", type=Path, required=True, metavar="PICTURE.png")
    said = parser.parse_args()
    samples, parameters, threads = over_samples(), over_parameters(), over_threads()
    print_table("samples", "ns a sample", samples)
    for curve in parameters:
        laws = [f"{size}: {time:.3g}" for size, time in zip(curve.at, curve.time, strict=True)]
        print(f"{curve.name}, ns a sample by the number of parameters: {', '.join(laws)}")
    print()
    print_table("at once", "s", threads)
    drawn(samples, parameters, threads).savefig(said.picture)


if __name__ == "__main__":
    main()

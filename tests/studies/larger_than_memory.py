"""Fits of ever larger data sets: memory, time and rate, as the README's table.

    python tests/studies/larger_than_memory.py FOLDER [--rows 1e6,1e7,1e8,1e9]

FOLDER needs 20 bytes of disk a row. The data set is one recording of a million samples with a
hidden Stribeck curve and load dependence, made by the package's own generator and repeated, each
time with fresh torque noise. Every fit runs in a process of its own, whose largest resident memory
the operating system reports. Files that are there are used again.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from stribeck.motion.generate.hidden import generate

#: Rows of one file, of the recording that is repeated, and of a row group.
FILE_ROWS, PIECE_ROWS, GROUP_ROWS = 10_000_000, 1_000_000, 262_144
RATE_HZ = 1000.0
#: RMS of the torque noise that is fresh in each repetition, N m.
FRESH_NOISE = 0.1
#: Pause between two repetitions, s: the joint has moved back to the start meanwhile.
PAUSE = 1.0
EFFECTS = ("stribeck", "load")

CHILD = """
import json, resource, sys
import stribeck as sb
fitted = sb.stream(sys.argv[1]).fit(sys.argv[2])
answer = fitted.to_dict()
# In kilobytes, as Linux has it.
answer["largest_resident_megabytes"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
print(json.dumps(answer))
"""


def write(folder: Path, rows: int) -> None:
    """Write the files of a data set of `rows` rows that are not there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    piece: pl.DataFrame | None = None
    for number, first in enumerate(range(0, rows, FILE_ROWS)):
        path = folder / f"part_{number:04d}.parquet"
        if path.exists():
            continue
        if piece is None:
            made, _ = generate(EFFECTS, seconds=PIECE_ROWS / RATE_HZ, rate=RATE_HZ, seed=1)
            piece = made.select("time", "velocity", "torque", "load_torque")
        parts = []
        for begin in range(first, min(first + FILE_ROWS, rows), PIECE_ROWS):
            part = piece.head(min(PIECE_ROWS, rows - begin))
            noise = np.random.default_rng([7, begin]).normal(0.0, FRESH_NOISE, part.height)
            since = begin / PIECE_ROWS * (PIECE_ROWS / RATE_HZ + PAUSE)
            parts.append(
                part.select(
                    pl.col("time") + since,
                    pl.col("velocity").cast(pl.Float32),
                    (pl.col("torque") + noise).cast(pl.Float32),
                    pl.col("load_torque").cast(pl.Float32),
                )
            )
        unfinished = path.with_suffix(".unfinished")
        pl.concat(parts).write_parquet(unfinished, row_group_size=GROUP_ROWS, compression="lz4")
        unfinished.rename(path)


def measured(folder: Path, model: str) -> dict[str, Any]:
    """The fit of `model` to the data set in `folder`, made in a process of its own."""
    command = [sys.executable, "-c", CHILD, str(folder), model]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def row(rows: int, answer: dict[str, Any]) -> str:
    """A row of the README's table."""
    data = answer["data"]
    cells = [
        f"{rows:.0e}".replace("e+0", "e"),
        f"{answer['seconds']:.3g} s",
        f"{data['rows_per_second'] / 1e6:.2g} million",
        f"{answer['largest_resident_megabytes']:.0f} MB",
    ]
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Print one row a size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--rows", default="1e6,1e7,1e8,1e9")
    parser.add_argument("--model", default="coulomb")
    given = parser.parse_args()
    print("| samples | time | samples/s | largest memory |")
    print("|---|---|---|---|")
    for rows in (round(float(text)) for text in given.rows.split(",")):
        folder = given.folder / f"{rows:.0e}"
        write(folder, rows)
        print(row(rows, measured(folder, given.model)), flush=True)


if __name__ == "__main__":
    main()

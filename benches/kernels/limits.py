"""How near each kernel comes to what the machine's arithmetic allows.

python benches/kernels/limits.py

The limit is the time that the adders, the multipliers and the dividers need at least for the
operations of a row, as many as were counted; how fast those are is measured in the same run. What
moves numbers, and whole-number operations on their bits, come on top of it in every kernel.
"""

from __future__ import annotations

import sys

import callgrind
import operations
import program


def least(counts: dict[str, float], peaks: dict[str, float]) -> float:
    """Nanoseconds that these operations need at least."""
    add, multiply = counts["add"], counts["multiply"]
    return max(
        add / peaks["add"],
        multiply / peaks["multiply"],
        (add + multiply) / peaks["add and multiply"],
        counts["divide"] / peaks["divide"] + counts["square root"] / peaks["square root"],
    )


def main() -> int:
    """Print the table; 0, too, where nothing can be counted."""
    try:
        callgrind.install()
    except callgrind.Unavailable as reason:
        print(f"skipped: the limits of the kernels, because {reason}")
        return 0
    path, rows, times, peaks = (
        program.build(),
        program.kernels(),
        program.times(),
        program.peaks(),
    )
    print("| kernel | ns a row | + - < | x | / | root | limit, ns | share |")
    print("|---|---|---|---|---|---|---|---|")
    for kernel, count in rows.items():
        found = operations.of(path, kernel)
        each = {kind: found[kind] / count for kind in operations.KINDS}
        limit, time = least(each, peaks), times[kernel]
        taken = " | ".join(f"{number:.3g}" for number in each.values())
        print(f"| {kernel} | {time:.3g} | {taken} | {limit:.2g} | {limit / time:.0%} |")
    rates = ", ".join(f"{kind} {rate:.3g}" for kind, rate in peaks.items())
    print(f"\nOperations a nanosecond at most, measured: {rates}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())

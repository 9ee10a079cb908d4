"""Prove on emulated microcontrollers that a step has the host's bits, does not panic, and is short.

python tests/embedded/run.py            # 1 where a figure, a bit or a symbol is not as it must be
python tests/embedded/run.py --write    # also keep the figures in table.md

Figures are instructions, which the emulator counts, not cycles and not time.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ThreadPoolExecutor

import exported
import figures
import images
import toolchain


def main() -> int:
    """Run everything; 0, or 1 with a sentence for everything that is wrong."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="keep the figures in table.md")
    said = parser.parse_args()
    try:
        toolchain.install()
    except toolchain.Unavailable as reason:
        print(f"skipped: the emulated microcontrollers, because {reason}")
        return 0
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(toolchain.sysroot, sorted({board.target for board in images.BOARDS})))
        outcomes = list(pool.map(prove, images.BOARDS))
    taken = {key: value for found, _ in outcomes for key, value in found.items()}
    wrong = [sentence for _, sentences in outcomes for sentence in sentences]
    print(figures.text(taken), end="")
    if said.write:
        figures.TABLE.write_text(figures.text(taken))
    wrong += figures.worse(taken, figures.kept())
    for board in images.BOARDS:
        print(
            f"{board.name}: {board.hashed} steps of every law with the host's bits, {board.number}"
        )
    for sentence in wrong:
        print(f"wrong: {sentence}", file=sys.stderr)
    return 1 if wrong else 0


def prove(board: images.Board) -> tuple[dict[figures.Key, figures.Figures], list[str]]:
    """The figures of one board, and what is wrong there."""
    image, catalog = images.build(board, "image"), images.build(board, "catalog")
    programs = [image, catalog] + ([images.build_interface(board)] if board.c_flags else [])
    wrong = [
        f"{path.name} for {board.name} contains {name}"
        for path in programs
        for name in images.forbidden(path)
    ]
    answers = images.run(board, image)
    expected = images.on_the_host(board.number, board.hashed)
    wrong += [
        f"{law} on {board.name} has not the host's bits over {board.hashed} steps"
        for law, value in expected.items()
        if answers[law].hash != value
    ]
    wrong += exported.differing(board) if board.c_flags else []
    sizes = images.sizes(image, list(answers))
    return {
        (law, board.name, board.number): figures.Figures(
            mean=round(answer.mean),
            largest=round(answer.largest),
            stack=answer.stack,
            code=sizes[law],
        )
        for law, answer in answers.items()
    }, wrong


if __name__ == "__main__":
    sys.exit(main())

"""Prove on emulated microcontrollers that a step has the host's bits, does not panic, and is short.

python tests/embedded/run.py            # 1 where a figure, a bit or a symbol is not as it must be
python tests/embedded/run.py --write    # also keep the figures in table.md

Figures are instructions, which the emulator counts, not cycles and not time.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ThreadPoolExecutor

import debian
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
    except debian.Unavailable as reason:
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
        counts = " and ".join(f"{each.steps(board)} steps of {each.name}" for each in board.tested)
        print(f"{board.name}: {counts} with the host's bits, {board.number}")
    for sentence in wrong:
        print(f"wrong: {sentence}", file=sys.stderr)
    return 1 if wrong else 0


def prove(board: images.Board) -> tuple[dict[figures.Key, figures.Figures], list[str]]:
    """The figures of one board, and what is wrong there."""
    found, wrong = {}, images.refused(board, images.build(board, "catalog"))
    if board.c_flags:
        wrong += images.refused(board, images.build_interface(board))
        wrong += exported.differing(board)
    for tested in board.tested:
        taken, sentences = prove_image(board, tested)
        found |= taken
        wrong += sentences
    return found, wrong


def prove_image(
    board: images.Board, tested: images.Tested
) -> tuple[dict[figures.Key, figures.Figures], list[str]]:
    """The figures of one image, and what is wrong with it."""
    image = images.build(board, "image", tested)
    wrong = images.refused(board, image)
    answers = images.run(board, image)
    expected = images.on_the_host(board.number, tested.steps(board), tested)
    wrong += [
        f"{name} on {board.name} has not the host's bits over {tested.steps(board)} steps"
        for name, value in expected.items()
        if answers[name].hash != value
    ]
    sizes = images.sizes(image, list(answers))
    return {
        (name, board.name, board.number): figures.Figures(
            mean=round(answer.mean),
            largest=round(answer.largest),
            stack=answer.stack,
            code=sizes[name],
        )
        for name, answer in answers.items()
    }, wrong


if __name__ == "__main__":
    sys.exit(main())

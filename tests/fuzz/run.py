#!/usr/bin/env python3
"""Run the command on random damage of good input, and count what it answers.

    python tests/fuzz/run.py --minutes 10 --seed 0

Each input is a good call with its files, of which bytes, lines, numbers or words were changed. The
answer must be code 0, or code 2 (1 from `check`) with one line; no hang, no abort, no file that is
partial, replaced or left behind. Exit code 1 if one answer was another; its input is printed.
"""

from __future__ import annotations

import argparse
import collections
import multiprocessing
import os
import random
import signal
import sys
import tempfile
import time
from pathlib import Path
from types import FrameType

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from hostile.contract import MOST, Answer, make_workspace, run, tree
from hostile.flags import FORMULAS, GOOD, NO_NUMBERS, SPECS

#: A command that takes longer than this hangs, s.
LONGEST = 90
#: Commands, by the file that is damaged.
OF_FILE = {
    "m.toml": [GOOD["check"], GOOD["validate"], GOOD["simulate"], ("compare", "log.csv", "m.toml")],
    "p.toml": [("project", "show", "p.toml"), GOOD["project save"], ("project", "back", "p.toml")],
    "log.csv.sidecar.toml": [GOOD["inspect"], GOOD["fit"]],
    "log.csv": [GOOD["inspect"], GOOD["fit"], GOOD["add"]],
}
WORDS = (
    *NO_NUMBERS, "1e308", "-1e308", "5e-324", "[", "]", "{}", '"', "'", "=", "\n", "\r", "\0", "#",
    "[[x]]", "true", "inf", "-0.0", "0", "1979-05-27", "é", "\ufeff", ",", ";", "\t", "[" * 3000,
)  # fmt: skip


def damaged(data: bytes, rng: random.Random) -> bytes:
    """Some bytes, words or lines changed."""
    for _ in range(rng.choice((1, 1, 1, 2, 5))):
        place, kind = rng.randrange(len(data) + 1), rng.randrange(6)
        if kind == 0:
            data = data[:place] + bytes([rng.randrange(256)]) + data[place + 1 :]
        elif kind == 1:
            data = data[:place] + rng.choice(WORDS).encode() + data[place:]
        elif kind == 2:
            data = data[:place]
        else:
            lines = data.split(b"\n")
            row = rng.randrange(len(lines))
            if kind == 3:
                del lines[row]
            elif kind == 4:
                lines.insert(rng.randrange(len(lines)), lines[row])
            else:
                key, mark, _ = lines[row].partition(b"=")
                lines[row] = key + mark + b" " + rng.choice(WORDS).encode()
            data = b"\n".join(lines)
    return data


def made(rng: random.Random, good: dict[str, bytes]) -> tuple[tuple[str, ...], str, bytes]:
    """A call, the file that is damaged and its content."""
    if rng.random() < 0.6:
        name = rng.choice(list(OF_FILE))
        return rng.choice(OF_FILE[name]), name, damaged(good[name], rng)
    words = list(GOOD[rng.choice(("fit", "check", "simulate", "add", "export", "compensate"))])
    kind = rng.randrange(3)
    if kind == 0:
        place = rng.randrange(1, len(words))
        words[place] = damaged(words[place].encode(), rng).decode(errors="replace")
    elif kind == 1:
        text = damaged(rng.choice((*FORMULAS, "c1*v + c2*tanh(v/c3)")).encode(), rng)
        words = ["fit", "log.csv", "--starts", "1", "--law", text.decode(errors="replace")[:9000]]
    else:
        words.append(rng.choice((*WORDS, *SPECS)))
    return tuple(words), "log.csv", good["log.csv"]


def problem(answer: Answer, words: tuple[str, ...], kept: bool) -> str | None:
    """What is wrong with an answer; None where nothing is."""
    if answer.code == 0 or (answer.code == 1 and words[0] == "check"):
        return f"warned: {answer.warned[0]}" if answer.warned else None
    line = answer.lines[-1] if answer.lines else ""
    checks = {
        f"code {answer.code}": answer.code == 2,
        "stdout is not empty": answer.out == "",
        "not one line": len(answer.lines) == 1 and line.isprintable(),
        "a long line": len(line) <= MOST,
        "a defect": "this is a defect" not in line and "Traceback" not in answer.err,
        "files changed": kept,
        "a warning": not answer.warned,
    }
    return next((said for said, holds in checks.items() if not holds), None)


def work(seed: int, until: float, answers: multiprocessing.SimpleQueue) -> None:
    """Run inputs until the time is over, and report each."""
    signal.signal(signal.SIGALRM, _hang)
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_workspace(Path(folder))
        good = {name: Path(name).read_bytes() for name in OF_FILE}
        beside = tree(Path(folder))
        while time.time() < until:
            words, name, content = made(rng, good)
            Path(name).write_bytes(content)
            before = tree(Path(folder))
            signal.alarm(LONGEST)
            answers.put(("began", words, name, content))
            try:
                answer = run(words)
                said = problem(answer, words, tree(Path(folder)) == before)
                code, text = answer.code, answer.err[-600:]
            except BaseException as error:
                said, code, text = f"raised {type(error).__name__}", -1, str(error)[:600]
            signal.alarm(0)
            answers.put(("ended", code, said, text))
            for place in set(tree(Path(folder))) - set(beside):
                os.system(f"rm -rf {place!r}")
            for file, data in good.items():
                Path(file).write_bytes(data)
    answers.put(("over",))


def _hang(number: int, frame: FrameType | None) -> None:
    raise TimeoutError("hangs")


def main() -> int:
    """Run one worker after the other, a new one where it was aborted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    # The cache of the user is no place for results of damaged input.
    os.environ["STRIBECK_LAST"] = "off"
    until = time.time() + 60.0 * asked.minutes
    codes: collections.Counter[object] = collections.Counter()
    wrong: list[str] = []
    seed = asked.seed
    while time.time() < until:
        answers = multiprocessing.get_context("spawn").SimpleQueue()
        worker = multiprocessing.get_context("spawn").Process(
            target=work, args=(seed, until, answers)
        )
        worker.start()
        last: object = None
        while worker.is_alive() or not answers.empty():
            if answers.empty():
                time.sleep(0.01)
                continue
            kind, *rest = answers.get()
            if kind == "began":
                last = rest
            elif kind == "ended":
                code, said, text = rest
                codes[code] += 1
                if said is not None:
                    wrong.append(f"{said}: {last!r}\n{text}")
                    print(wrong[-1][:1500], flush=True)
        worker.join()
        if worker.exitcode != 0:
            wrong.append(f"aborted with {worker.exitcode}: {last!r}")
            print(wrong[-1][:1500], flush=True)
        seed += 1
    total = sum(codes.values())
    print(f"{total} inputs, seed {asked.seed}: codes {dict(codes)}, {len(wrong)} wrong answers")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())

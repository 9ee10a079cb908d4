"""Write the references again: python tests/python/same/record.py [STORY...]

They say what the commands answered before a change that must not alter an answer. So run this with
the product as it was, never with the code under test:

    PYTHONPATH=/path/of/the/old/tree/python python tests/python/same/record.py

Where a change of an answer is meant, record that story alone and say in the commit why it changed.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from same_answers import EXPECTED, SHARED, dumped, machine, stored, stories, tell


def main() -> None:
    wanted = sys.argv[1:]
    chosen = [story for story in stories() if not wanted or story.name in wanted]
    if not chosen or len(chosen) < len(set(wanted)):
        raise SystemExit(f"stories are: {', '.join(story.name for story in stories())}")
    if not SHARED.is_dir():
        raise SystemExit(f"{SHARED} is needed")
    EXPECTED.mkdir(exist_ok=True)
    for story in chosen:
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            made = tell(story, Path(folder))
        stored(story).write_text(dumped(machine(), made))
        codes = " ".join(str(answer["exit"]) for answer in made)
        print(f"{story.name}: {time.monotonic() - began:.1f} s, exit codes {codes}", flush=True)


if __name__ == "__main__":
    main()

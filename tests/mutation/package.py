"""Changes of the Python package by the operators of Cosmic Ray, each in a process of its own.

Of the changes at one place in the text, such as a plus that becomes one of eleven operators, one is
drawn: places count alike. Annotations are not changed, since nothing evaluates them; nor are the
thresholds at the head of a module, which the scoreboard judges and not the tests.
"""

from __future__ import annotations

import ast
import multiprocessing
import os
import random
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

import limited
import pytest
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names
from mutant import ROOT, Mutant, Sample, copy_of_the_sources

#: Files of each area, and the quick tests that read them.
AREAS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "evidence": (
        ("diagnosis/trials/evidence.py",),
        ("diagnosis/test_evidence.py", "fitting/test_weights.py"),
    ),
    "ranking": (
        ("diagnosis/trials/ranking.py", "diagnosis/trials/sifting.py"),
        ("diagnosis/test_ranking.py", "diagnosis/test_order.py"),
    ),
    "held-out": (
        ("identify/held_out.py",),
        ("identify/test_held_out.py",),
    ),
    "covariance": (("identify/errors/covariance.py",), ("identify/errors/test_covariance.py",)),
    "transients": (("identify/left_out/transients.py",), ("identify/left_out/test_transients.py",)),
    "residual": (
        tuple(f"diagnosis/residual/{name}.py" for name in
              ("noise_floor", "regimes", "unexplained", "varying_friction", "explainable")),
        tuple(f"diagnosis/test_{name}.py" for name in
              ("regimes", "unexplained", "varying_friction", "noise_floor", "explainable")),
    ),
}  # fmt: skip
#: Processor time after which the tests of an area hang, s.
LONGEST = 120
EXTENSION = "python/stribeck/_core.abi3.so"
#: Libraries that the tests load, loaded once for all of them.
PRELOADED = ("numpy", "scipy.interpolate", "scipy.optimize", "scipy.signal", "scipy.spatial",
             "scipy.stats", "polars", "pytest", "click", "rich.console",
             "tomlkit", "joblib")  # fmt: skip


def listed(area: str, root: Path) -> dict[Mutant, str]:
    """One change at each place of an area, with the changed text of its file."""
    found: dict[Mutant, str] = {}
    for name in AREAS[area][0]:
        file = f"python/stribeck/{name}"
        code = (root / file).read_text(encoding="utf-8")
        unchanged = _left_alone(ast.parse(code))
        by_place: dict[tuple[int, int], list[str]] = defaultdict(list)
        for place, changed in _changes(code):
            if not any(first <= place < last for first, last in unchanged):
                by_place[place].append(changed)
        rng = random.Random(file)
        for place, changes in sorted(by_place.items()):
            changed = rng.choice(sorted(changes))
            line = place[0]
            before = code.splitlines()[line - 1].strip()
            after = changed.splitlines()[line - 1].strip()
            found[Mutant(area, file, line, before, after)] = changed
    return found


def _changes(code: str) -> Iterator[tuple[tuple[int, int], str]]:
    """Line, column and text of every change that the operators make."""
    tree = get_ast(code)
    for name in operator_names():
        if get_operator(name).arguments():
            continue
        operator = get_operator(name)()
        places = [p for node in ast_nodes(tree) for p in operator.mutation_positions(node)]
        for occurrence, ((line, column), _) in enumerate(places):
            changed = mutate_code(code, operator, occurrence)
            if changed is not None and changed != code:
                yield (line, column), changed


def _left_alone(tree: ast.Module) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Places of annotations, which stay text, and of the constants at the head of a module."""
    nodes: list[ast.expr | None] = [n.value for n in tree.body if isinstance(n, ast.Assign)]
    for node in ast.walk(tree):
        if isinstance(node, ast.arg | ast.AnnAssign):
            nodes.append(node.annotation)
        elif isinstance(node, ast.FunctionDef):
            nodes.append(node.returns)
    return [
        ((n.lineno, n.col_offset), (n.end_lineno or n.lineno, n.end_col_offset or 0))
        for n in nodes
        if n is not None
    ]


def test(sample: Sample, areas: Sequence[str]) -> dict[Mutant, str]:
    """What the tests make of each change: "caught" or "survived"."""
    root = copy_of_the_sources("package")
    (root / EXTENSION).write_bytes((ROOT / EXTENSION).read_bytes())
    settings = {"PYTHONPATH": str(root / "python"), "OMP_NUM_THREADS": "1"}
    os.environ.update(settings, PYTHONDONTWRITEBYTECODE="1")
    forked = multiprocessing.get_context("forkserver")
    forked.set_forkserver_preload(list(PRELOADED))
    results: dict[Mutant, str] = {}
    for area in areas:
        tests = [f"tests/python/{name}" for name in AREAS[area][1]]
        words = ["-x", "-q", "-p", "no:cacheprovider", "-m", "not slow and not long", *tests]
        # Without a change all must pass. This also compiles the modules once for all changes.
        command = [sys.executable, "-m", "pytest", *words]
        done = limited.run(command, root, LONGEST, {"PYTHONDONTWRITEBYTECODE": ""})
        if done.returncode != 0:
            raise SystemExit(f"fails without a change: {' '.join(tests)}\n{done.stdout[-3000:]}")
        changes = listed(area, root)
        for mutant in sample.of(list(changes)):
            path = root / mutant.file
            original = path.read_text(encoding="utf-8")
            path.write_text(changes[mutant], encoding="utf-8")
            process = forked.Process(target=_tested, args=(root, words))
            process.start()
            process.join(60 * LONGEST)
            process.kill()
            path.write_text(original, encoding="utf-8")
            results[mutant] = "survived" if process.exitcode == 0 else "caught"
            print(f"{results[mutant]:<9} {area:<10} {mutant}", flush=True)
    return results


def _tested(root: Path, words: list[str]) -> None:
    """Run pytest in this process, forked from one that has loaded the libraries."""
    limited.limit(LONGEST)
    os.chdir(root)
    sys.path.insert(0, str(root / "python"))
    sys.dont_write_bytecode = True
    with open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)
        os.dup2(nothing.fileno(), 2)
        sys.exit(pytest.main(words))

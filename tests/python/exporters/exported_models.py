"""Models to export, and the compilers and checkers that judge what is written."""

from __future__ import annotations

import os
import shutil
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.models.catalog import effect_ids, law_ids

FLAGS = (
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Werror",
    "-pedantic",
    "-O2",
    "-ffp-contract=off",
)

#: An effect by formula that no effect of the catalog has.
CREEP = "creep = creep_torque*tanh(v/creep_speed) + exp(-abs(q))*creep_bias"


def needs(tool: str) -> str:
    """The path of a tool, installed where that can be; else a skip that says what is missing."""
    path = _installed(tool)
    if path is None:
        pytest.skip(f"{tool} is not installed (Debian: apt-get install {tool})")
    return path


@cache
def _installed(tool: str) -> str | None:
    if shutil.which(tool) is None and shutil.which("apt-get") and os.geteuid() == 0:
        # Another process of the tests may be at it; a mirror may never answer.
        command = ["timeout", "300", "apt-get", "-o", "DPkg::Lock::Timeout=240", "--yes"]
        command += ["install", "--no-install-recommends", tool]
        environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
        subprocess.run(
            command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=False
        )
    return shutil.which(tool)


def valued(model: sb.Model, rng: np.random.Generator) -> sb.Model:
    """The model with values around its starts, none of them 0."""
    starts = [p.start if np.isfinite(p.start) and p.start != 0.0 else 0.3 for p in model.parameters]
    return model.with_values(np.array(starts) * rng.uniform(0.5, 1.5, len(starts)))


def random_model(seed: int) -> sb.Model:
    """A law of the catalog or a formula, some effects, and sometimes an effect by formula."""
    rng = np.random.default_rng(seed)
    if seed % 7 == 6:
        made = sb.law("Fc*sgn(v) + (Fs - Fc)*exp(-(abs(v)/vs)**1.5)*sgn(v) + b*cbrt(v)")
    else:
        made = sb.model(str(rng.choice(law_ids())))
    for effect in rng.permutation(effect_ids())[: rng.integers(0, 5)]:
        taken = made.has(str(effect)) or effect == "delay"
        if not taken and not (effect == "presliding" and made.has_state):
            try:
                made = made.with_effect(str(effect), {})
                made.core.constants  # noqa: B018  a combination that is refused raises here
            except sb.SpecError:
                made = made.without_effect(str(effect))
    if seed % 3 == 0:
        made = made.with_effect(CREEP, {})
    return valued(made, rng)


def compile_and_run(compiler: str, files: tuple[Path, ...], *more: str) -> int:
    """Compile sources without a warning; the exit code of the program."""
    folder = files[0].parent
    program = folder / f"self_test_{Path(compiler).name}"
    sources = [str(path) for path in files if path.suffix == ".c"]
    subprocess.run([compiler, *FLAGS, *sources, "-o", str(program), *more], check=True)
    return subprocess.run([str(program)], check=False).returncode

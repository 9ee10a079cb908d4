"""Exported Rust is a module of the crate that gives the bits of its test vectors."""

from __future__ import annotations

import itertools
import os
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from exported_models import CREEP, needs, random_model, valued
from exported_robots import WRIST, friction_of, made_robot
from stribeck.exporters.robot.export import export_robot

ROOT = Path(__file__).resolve().parents[3]

_MANIFEST = """
[package]
name = "exported"
version = "0.1.0"
edition = "2024"

[dependencies]
stribeck = {{ path = "{root}", default-features = false }}

[workspace]
"""


@pytest.mark.slow
def test_exported_modules_pass_their_own_tests(tmp_path: Path) -> None:
    cargo = needs("cargo")
    source = tmp_path / "src"
    modules = []
    for seed in range(12):
        precision = ("f64", "f32")[seed % 2]
        name = f"joint_{seed}"
        sb.export(random_model(seed), "rust", source, precision=precision, name=name)
        modules.append(f"pub mod {name};")
    coupled = replace(made_robot(), coupling=WRIST)
    for precision, robot in itertools.product(("f64", "f32"), (made_robot(), coupled)):
        friction = friction_of(robot)
        own = sb.law("Fc*sgn(v) + b*cbrt(v)").with_effect(CREEP, {})
        friction["axis 2"] = valued(own, np.random.default_rng(2))
        name = f"{'coupled' if robot is coupled else 'robot'}_{precision}"
        export_robot(robot, friction, "rust", source, precision=precision, name=name)
        modules.append(f"pub mod {name};")
    (source / "lib.rs").write_text(
        "#![no_std]\n#[cfg(test)]\nextern crate std;\n" + "\n".join(modules)
    )
    (tmp_path / "Cargo.toml").write_text(_MANIFEST.format(root=ROOT))
    (tmp_path / "Cargo.lock").write_text((ROOT / "Cargo.lock").read_text())
    environment = {**os.environ, "CARGO_TARGET_DIR": str(tmp_path / "target")}
    command = [cargo, "test", "--quiet", "--offline"]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "16 passed" in done.stdout

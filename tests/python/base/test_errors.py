"""Options in sentences: as keyword arguments in Python, as flags on the command line."""

from __future__ import annotations

import doctest

import pytest
from stribeck.base import errors
from stribeck.base.errors import option
from stribeck.cli import flags
from stribeck.cli.flags import with_flags


@pytest.mark.parametrize("module", [errors, flags])
def test_examples(module: object) -> None:
    assert doctest.testmod(module).failed == 0  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("python", "command_line"),
    [
        (option("map", "time=COLUMN"), "--map time=COLUMN"),
        (option("map", "time=t", "velocity=v"), "--map time=t --map velocity=v"),
        (option("hold_out", "day"), "--hold-out day"),
        (option("torque_constant"), "--torque-constant"),
        (option("gear_ratio", 0), "--gear-ratio 0"),
        (option("gear_ratio", -1.5), "--gear-ratio -1.5"),
        (option("where", "`motor speed` > 3"), "--where '`motor speed` > 3'"),
        (option("derive", "torque=`i [A]`*2"), "--derive 'torque=`i [A]`*2'"),
        ("column `load_torque` of `stribeck fit`", "column `load_torque` of `stribeck fit`"),
    ],
)
def test_an_option_is_spelt_as_a_flag(python: str, command_line: str) -> None:
    sentence = "a.csv: say which with {}, or use {}"
    assert with_flags(sentence.format(python, python)) == sentence.format(
        command_line, command_line
    )

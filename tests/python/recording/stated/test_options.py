"""The reading options are stated once: Python, the command line and the sidecar read one table."""

from __future__ import annotations

import doctest
from dataclasses import fields

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stribeck.base.errors import RecordingError
from stribeck.cli.fit import fit
from stribeck.projects.source import READING
from stribeck.recording.stated import options
from stribeck.recording.stated.options import TABLE, ReadArguments, ReadOptions, split_pairs

NUMBERS = [entry.name for entry in TABLE if entry.kind == "number"]


def test_examples() -> None:
    assert doctest.testmod(options).failed == 0


def test_editors_know_the_options() -> None:
    """The keyword arguments that type checkers see are those of the table, with their types."""
    typed = {name: str(kind) for name, kind in ReadArguments.__annotations__.items()}
    stated = {f.name: str(f.type) for f in fields(ReadOptions)}
    assert list(typed) == list(stated) == [entry.name for entry in TABLE]
    for name, kind in typed.items():
        assert f"'{stated[name]}'" in kind


def test_the_command_line_has_a_flag_for_each() -> None:
    flags = {name for parameter in fit.params for name in parameter.opts}
    for entry in TABLE:
        flag = "--" + entry.name.replace("_", "-")
        assert (flag in flags) == entry.command_line
    assert set(READING) == {entry.name for entry in TABLE}


def test_an_unknown_option_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="jiont"):
        ReadOptions(jiont="1")  # type: ignore[call-arg]


def test_only_what_is_not_the_default_is_given() -> None:
    assert ReadOptions(map=[], unit={}, joint=None, standstill=False).given() == {}
    given = {"inertia": 0.0, "map": ["time=t"], "where": "", "standstill": True}
    assert ReadOptions(**given).given() == given


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", ["much", float("nan"), float("inf")])
def test_numbers_are_finite(name: str, value: object) -> None:
    with pytest.raises(RecordingError, match=rf"^`{name}=.*`: (is not a|must be a finite) number"):
        ReadOptions(**{name: value}).number(name)


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("gear_ratio", 0, "`gear_ratio=0`: must not be zero"),
        ("torque_constant", -0.5, "`torque_constant=-0.5`: must be above zero"),
        ("km", 0, "`km=0`: must be above zero"),
        ("inertia", -1, "`inertia=-1`: must not be negative"),
    ],
)
def test_numbers_keep_their_limits(name: str, value: float, sentence: str) -> None:
    with pytest.raises(RecordingError, match=sentence):
        ReadOptions(**{name: value}).number(name)


_SIDE = st.text(min_size=1).map(str.strip).filter(bool)


@settings(deadline=None)
@given(_SIDE.filter(lambda name: "=" not in name), _SIDE)
def test_pairs_split_beside_the_name(name: str, value: str) -> None:
    """A formula may hold '=', and so may a column that is given a unit."""
    assert split_pairs("derive", f"{name}={value}") == {name: value}
    assert split_pairs("unit", [f"{value} = {name}"]) == {value: name}

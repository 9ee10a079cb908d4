"""Model files: the same bits come back; what is not understood is refused with its line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from hypothesis import given, settings
from hypothesis import strategies as st
from stribeck.models.reader import TOP_KEYS, parse_model_file
from stribeck.models.writer import SCHEMA

AWKWARD = (0.1, 1.0 / 3.0, np.pi * 1e-9, 1.7976931348623157e308, 5e-324, -0.0, 1e22, 123456789.125)


def example() -> sb.ModelFile:
    """A model file with everything in it."""
    m = sb.model(
        "coulomb+load",
        constants={"reference_load": 1.0 / 3.0},
        coulomb_friction=2.1,
        viscous_friction=np.nextafter(0.5, 1.0),
        load_coulomb=0.1,
        load_exponent=1.0,
    )
    m = replace(
        m,
        bounds={"coulomb_friction": (0.0, 30.000000000000004)},
        box={"velocity": (-1.1, 1.3), "load_torque": (-5.0, 1e-17)},
    ).with_values(m.values)
    return sb.ModelFile(
        m,
        stderr={"coulomb_friction": 0.01234567890123456789},
        fitted_on={
            "path": "some where/join't.csv",
            "sha256": "ab" * 32,
            "rows": 100,
            "time_span": [0.0, 12.34],
            "rmse": 0.1,
        },
    )


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """The example on disk."""
    target = tmp_path / "m.toml"
    example().write(target)
    return target


def test_round_trip_gives_the_same_bits(path: Path) -> None:
    made, read = example(), sb.read_model_file(path)
    assert read.model.values.tobytes() == made.model.values.tobytes()
    assert read.model.spec == made.model.spec and read.model.constants == made.model.constants
    assert dict(read.model.bounds) == dict(made.model.bounds)
    assert dict(read.model.box) == dict(made.model.box)
    assert dict(read.stderr) == dict(made.stderr) and dict(read.fitted_on) == dict(made.fitted_on)
    again = path.with_name("again.toml")
    read.write(again)
    assert again.read_bytes() == path.read_bytes()


@pytest.mark.parametrize("value", AWKWARD)
def test_any_double_comes_back(tmp_path: Path, value: float) -> None:
    m = sb.model("coulomb+offset", a1=1.0, a2=1.0, t0=value)
    m.save(str(tmp_path / "m.toml"))
    back = sb.load(tmp_path / "m.toml").value("offset")
    assert np.float64(back).tobytes() == np.float64(value).tobytes()


@settings(max_examples=200, deadline=None)
@given(law=st.sampled_from(sb.laws()["id"].to_list()), data=st.data())
def test_every_value_comes_back(law: str, data: st.DataObject) -> None:
    m = sb.model(law)
    finite = st.floats(allow_nan=False, allow_infinity=False)
    m = m.with_values(data.draw(st.lists(finite, min_size=m.values.size, max_size=m.values.size)))
    back = parse_model_file(sb.ModelFile(m).to_toml(), Path("m.toml")).model
    assert back.values.tobytes() == m.values.tobytes()


def test_file_is_readable_by_people(path: Path) -> None:
    text = path.read_text()
    assert text.startswith('kind = "model"\nschema = 1\nlaw = "coulomb"')
    assert "[parameters.coulomb_friction]" in text and 'unit = "N m"' in text
    # An edited value, comment and order are read.
    edited = text.replace("value = 2.1", "value = 2.25 # by hand")
    path.write_text(edited)
    assert sb.load(path).value("coulomb_friction") == 2.25


@pytest.mark.parametrize(
    ("old", "new", "line_with", "said"),
    [
        ('kind = "model"', 'kind = "recording"', "kind =", "recording"),
        ("schema = 1", "schema = 99", "schema =", "99"),
        ('law = "coulomb"', 'law = "colomb"', "law =", "did you mean 'coulomb'"),
        ('effects = ["load"]', 'effects = ["laod"]', "effects =", "did you mean 'load'"),
        ("position_unit", "positon_unit", "positon_unit", "did you mean 'position_unit'"),
        ('torque_unit = "N m"', 'torque_unit = "lbf"', "torque_unit", "lbf"),
        ('position_unit = "rad"', 'position_unit = "deg"', "position_unit", "deg"),
        ("value = 2.1", "value = nan", "value = nan", "finite"),
        ("value = 2.1", "value = -inf", "value = -inf", "finite"),
        ("value = 2.1", "value = true", "value = true", "number"),
        ("value = 2.1", 'value = "2.1"', 'value = "2.1"', "number"),
        ("value = 2.1", "value = 2.1\ncolour = 1", "colour", "colour"),
        ("stderr = 0.0123", "sdterr = 0.0123", "sdterr", "did you mean 'stderr'"),
        ('unit = "N m"\nbounds', 'unit = "N"\nbounds', 'unit = "N"\n', "N m"),
        ("rmse = 0.1", "rmes = 0.1", "rmes", "did you mean 'rmse'"),
        (
            "[parameters.load_exponent]",
            "[parameters.load_exponnt]",
            "load_exponnt",
            "did you mean 'load_exponent'",
        ),
        ("bounds = [0.0, 30.000000000000004]", "bounds = [0.0]", "bounds = [0.0]", "two numbers"),
        ("bounds = [0.0, 30.000000000000004]", "bounds = [0.0, 2.0]", "bounds = [0.0, 2", "2.1"),
        ("stderr = 0.0123", "stderr = -0.0123", "stderr = -0.0", "below zero"),
        ("velocity = [-1.1, 1.3]", "velocity = [-1.1, nan]", "velocity = [-1.1", "finite"),
    ],
)
def test_what_is_wrong_is_refused_with_its_line(
    path: Path, old: str, new: str, line_with: str, said: str
) -> None:
    good = path.read_text()
    assert old in good
    bad = good.replace(old, new, 1)
    path.write_text(bad)
    line = bad[: bad.index(line_with)].count("\n") + 1
    with pytest.raises(sb.ModelFileError) as caught:
        sb.read_model_file(path)
    assert said in str(caught.value) and "m.toml" in str(caught.value)
    assert f"line {line}:" in str(caught.value)


def test_missing_parts_are_named(path: Path) -> None:
    good = path.read_text()
    head, rest = good.split("[parameters.load_exponent]")
    path.write_text(head + "[fitted_on]" + rest.split("[fitted_on]")[1])
    with pytest.raises(sb.ModelFileError, match="load_exponent of coulomb\\+load is missing"):
        sb.load(path)
    path.write_text(good.replace('law = "coulomb"\n', ""))
    with pytest.raises(sb.ModelFileError, match="law"):
        sb.load(path)
    path.write_text(good[: len(good) // 2])
    with pytest.raises(sb.ModelFileError, match=r"m\.toml"):
        sb.load(path)


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b"[[[", b'kind = "model"'])
def test_no_model_file_at_all(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "m.toml").write_bytes(content)
    with pytest.raises(sb.ModelFileError, match=r"m\.toml"):
        sb.load(tmp_path / "m.toml")
    with pytest.raises(sb.ModelFileError, match=r"absent\.toml"):
        sb.load(tmp_path / "absent.toml")


@pytest.mark.parametrize("content", [b"time,velocity\n0.0,1.0\n", b"PAR1\xff\xfe"])
def test_a_recording_in_place_of_a_model_is_told_where_it_is_read(
    tmp_path: Path, content: bytes
) -> None:
    path = tmp_path / "data.csv"
    path.write_bytes(content)
    with pytest.raises(
        sb.ModelFileError, match=r"data\.csv.*a model file is TOML.*`stribeck inspect`"
    ):
        sb.load(path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('effects = ["load"]', 'effects = "load"'),
        ('effects = ["load"]', "effects = [1]"),
        ("rigid_body = []", 'rigid_body = ["mass"]'),
        ("rigid_body = []", "rigid_body = 3"),
        ("[fitted_on]", "[fitted_on]\nsha256 = 3"),
        ("reference_load = 0.", "reference_laod = 0."),
        ("reference_load = 0.", "reference_load = -0."),
        ("[box]", "[box]\ntemprature = [0.0, 1.0]"),
    ],
)
def test_wrong_types_are_refused_in_a_sentence(path: Path, old: str, new: str) -> None:
    good = path.read_text()
    assert old in good
    path.write_text(good.replace(old, new, 1))
    with pytest.raises(sb.ModelFileError, match=r"m\.toml"):
        sb.read_model_file(path)


def test_nothing_is_written_when_it_fails(tmp_path: Path, path: Path) -> None:
    unfitted = sb.model("coulomb")
    target = tmp_path / "new.toml"
    with pytest.raises(sb.ModelFileError, match="no value for"):
        unfitted.save(str(target))
    assert not target.exists()
    before = path.read_bytes()
    with pytest.raises(sb.ModelFileError):
        unfitted.save(str(path))
    assert path.read_bytes() == before
    with pytest.raises(sb.ModelFileError, match="nowhere"):
        example().write(tmp_path / "nowhere" / "m.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(sb.ModelFileError, match="cannot write"):
        example().write(tmp_path / "folder.toml")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["folder.toml", "m.toml"]


def test_schema_is_versioned() -> None:
    assert SCHEMA == 1 and {"kind", "schema", "law", "parameters"} <= set(TOP_KEYS)

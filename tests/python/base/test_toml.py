"""TOML files: errors name the file and the line."""

from __future__ import annotations

from pathlib import Path

import pytest
from stribeck.base.errors import ModelFileError, ProjectError
from stribeck.base.toml import TomlText, read_text

TEXT = """kind = "model"

[nodes.1]
value = 1

[nodes.2]
value = "much"
"""


def test_the_last_word_is_searched_after_the_ones_before() -> None:
    source = TomlText(Path("a.toml"), TEXT, ModelFileError)
    assert str(source.stop("wrong")) == "a.toml: wrong"
    assert str(source.stop("wrong", "value")) == "a.toml, line 4: wrong"
    assert str(source.stop("wrong", "nodes.2", "value")) == "a.toml, line 7: wrong"
    assert str(source.stop("wrong", "nodes.2", "absent")) == "a.toml, line 6: wrong"
    under = TomlText(Path("a.toml"), TEXT, ProjectError, ("nodes.2",))
    assert str(under.stop("wrong", "value")) == "a.toml, line 7: wrong"
    assert type(under.stop("wrong")) is ProjectError


def test_unknown_keys_are_refused_with_the_nearest() -> None:
    source = TomlText(Path("a.toml"), TEXT, ModelFileError)
    source.check_keys(source.parsed(), ("kind", "nodes"))
    with pytest.raises(ModelFileError, match=r"line 1: key 'kind' is unknown; did you mean 'king'"):
        source.check_keys(source.parsed(), ("king", "nodes"))


def test_what_is_not_toml_or_not_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelFileError, match="not a TOML file"):
        TomlText(Path("a.toml"), "kind = ", ModelFileError).parsed()
    path = tmp_path / "a.toml"
    with pytest.raises(ProjectError, match=r"cannot read the project .*No such file"):
        read_text(path, "project", ProjectError)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ProjectError, match="it is not text"):
        read_text(path, "project", ProjectError)

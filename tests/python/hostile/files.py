"""Rows of files that people edit: model files, sidecars and projects with one line changed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

#: What no number of a file may be, and what no text may be.
_NO_NUMBERS = ("nan", "inf", '"low"', "true", "[1]", "{}", "9" * 400, "1979-05-27", "", "1e999")
_NO_TEXTS = ("1", "true", "[1]", "{}", "nan", "[[]]", "9" * 400, "")
_NO_TABLES = ("1", '"x"', "[1]", "true", "nan")
_DEEP = "x = " + "[" * 5000 + "]" * 5000
_NEST = "\n".join(f"[{'.'.join(['a'] * depth)}]" for depth in range(1, 200))

#: Lines of each file, and what may not stand after their equals sign.
_LINES: dict[str, dict[str, tuple[str, ...]]] = {
    "m.toml": {
        "value = ": _NO_NUMBERS, "bounds = ": ("1", "[1]", "[2, 1]", '["a", "b"]', "[nan, 1]"),
        "stderr = ": _NO_NUMBERS, "rmse = ": ('"low"', "true", "[1]", "{}", "9" * 400),
        "time_span = ": ("1", "[1]", '["a", "b"]', "[nan, 1]"), "rows = ": ('"x"', "1.5", "true"),
        "kind = ": ('"recording"', "1", '"project"'), "schema = ": ("2", '"x"', "nan"),
        "law = ": (*_NO_TEXTS, '"nope"', '"c c"'), "velocity = ": ("[1]", "[1, -1]", '"x"'),
        "effects = ": ("1", '"load"', '["nope"]', "[1]", '["load", "load"]'),
        "torque_unit = ": ('"lbf"', "1"), "position_unit = ": ('"deg"', "1"),
        "rigid_body = ": ("1", "[1]"), "unit = ": ('"lbf"', "1"), "sha256 = ": ("1", "true"),
    },
    "log.csv.sidecar.toml": {
        "kind = ": ('"model"', "1", "nan"), "joint_kind = ": ('"hinge"', *_NO_TEXTS),
    },
    "p.toml": {
        "kind = ": ('"model"', "1"), "schema = ": ("2", '"x"'), "current = ": ('"x"', "99", "1.5"),
        "path = ": _NO_TEXTS, "sha256 = ": (*_NO_TEXTS, '"x"'), 
        "change = ": (*_NO_TEXTS, '"nope"'), "value = ": _NO_NUMBERS, "rmse = ": ('"low"', "nan"),
    },
}  # fmt: skip
#: Lines that may not be added at the beginning of a file.
_ADDED = (
    "x = 1", "= 1", "[", "kind", _DEEP, _NEST, "km = " + "9" * 400, "\x00", "kind = 1", "\x80",
    "x = \"", "[[kind]]", "é = 1", "[a]\n[a]",
)  # fmt: skip
_READING: dict[str, tuple[str, ...]] = {
    "gear_ratio": ('"x"', "nan", "true", "[1]", "{}", "0"), "map": ("1", "[1]", "true", '"x"'),
    "where": ("1", "[1]", "true"), "joint": ("1.5", "[1]", "true"), "unit": ("1", "[1]", '"x"'),
    "unwrap": ("1", '"x"', "[1]"), "inertia": ('"x"', "nan", "[1]"), "sidecar": ("1", "[1]"),
    "nope": ("1",), "average": ("1", "[1]", '"nope"'), "derive": ("1", "[1]", '"x"'),
}  # fmt: skip
#: The command that reads each file.
READ_BY = {
    "m.toml": ("check", "m.toml"),
    "log.csv.sidecar.toml": ("fit", "log.csv", "--model", "coulomb"),
    "p.toml": ("project", "diagnose", "p.toml"),
}


def changes(folder: Path) -> Iterator[tuple[str, str, bytes]]:
    """The name of each row, the file it changes and the new content."""
    for name, lines in _LINES.items():
        good = (folder / name).read_text()
        for line, values in lines.items():
            assert f"\n{line}" in f"\n{good}", (name, line)
            for value in values:
                before, _, after = f"\n{good}".partition(f"\n{line}")
                rest = after.partition("\n")[2]
                text = f"{before}\n{line}{value}\n{rest}".lstrip("\n")
                yield f"{name}: {line}{value[:20]}", name, text.encode()
        for added in _ADDED:
            content = added.encode("latin-1") + b"\n" + good.encode()
            yield f"{name}: {added[:20]!r}", name, content
        for content in (b"", b"\xff\xfe", b"PAR1", good.encode()[: len(good) // 3] + b"\n["):
            yield f"{name}: {content[:9]!r}", name, content
    good = (folder / "p.toml").read_text()
    assert "\n[nodes" in good
    for key, values in _READING.items():
        for value in values:
            text = good.replace("\n[nodes", f"\n[reading]\n{key} = {value}\n\n[nodes", 1)
            yield f"p.toml: [reading] {key} = {value[:20]}", "p.toml", text.encode()

"""Rows of the command line: values of options, specs and formulas."""

from __future__ import annotations

from collections.abc import Iterator

import click
from stribeck.cli.main import cli
from stribeck.cli.outputs import Output

Row = tuple[str, ...]

_MOTION = ("--inertia", "0.1", "--to", "1", "--speed", "1", "--seconds", "1")
#: A good call of each command; a row adds one hostile option.
GOOD: dict[str, Row] = {
    "inspect": ("inspect", "log.csv"),
    "fit": ("fit", "log.csv", "--model", "coulomb"),
    "compare": ("compare", "log.csv", "coulomb"),
    "diagnose": ("diagnose", "log.csv", "coulomb"),
    "add": ("add", "log.csv", "coulomb", "stribeck"),
    "improve": ("improve", "log.csv", "--max-steps", "0"),
    "plan": (
        "plan", "m.toml", "--show", "stribeck", "--position=-1:1", "--speed", "1",
        "--acceleration", "5", "--noise", "0.01",
    ),
    "check": ("check", "m.toml"),
    "simulate": ("simulate", "m.toml", *_MOTION),
    "compensate": ("compensate", "m.toml", *_MOTION),
    "validate": ("validate", "log.csv", "m.toml"),
    "export": ("export", "m.toml", "--to", "c", "new"),
    "points": ("points", "log.csv", "--method", "averaging"),
    "arm": ("arm", "log.csv", "--first-link-length", "0.3"),
    "study": ("study", "log.csv", "--law", "coulomb", "--workers", "1", "-o", "new"),
    "fleet": ("fleet", "log.csv", "--model", "coulomb", "--workers", "1", "-o", "new"),
    "generate": ("generate", "-o", "new.csv"),
    "demo": ("demo", "-o", "new"),
    "benchmark diagnosis": ("benchmark", "diagnosis", "--quick", "-o", "new"),
    "project diagnose": ("project", "diagnose", "p.toml"),
    "project add": ("project", "add", "p.toml", "stribeck"),
    "project improve": ("project", "improve", "p.toml", "--max-steps", "0"),
    "project save": ("project", "save", "p.toml", "-o", "new.toml"),
    "project new": ("project", "new", "new.toml", "log.csv"),
}  # fmt: skip

_NUMBERS = (click.types.FloatParamType, click.types.IntParamType)
#: No number that any option takes.
NO_NUMBERS = ("nan", "-nan", "1e999", "abc", "", "9" * 400, "1;2", "0x1g")
#: Numbers far outside of all that an option may mean.
FAR = ("-inf", "-1e300", "1e300")
#: Options for which infinity means that there is no limit.
UNLIMITED = ("limit",)


def command_of(name: str) -> click.Command:
    """A command by the words that call it."""
    found: click.Command = cli
    context = click.Context(cli)
    for word in name.split():
        assert isinstance(found, click.Group)
        made = found.get_command(context, word)
        assert made is not None
        found = made
    return found


def numbers() -> Iterator[Row]:
    """Every numeric option of every command with what is no number."""
    for name, good in GOOD.items():
        for option in command_of(name).params:
            if not isinstance(option, click.Option) or not isinstance(option.type, _NUMBERS):
                continue
            whole = isinstance(option.type, click.types.IntParamType)
            values = NO_NUMBERS if whole else (*NO_NUMBERS, *FAR)
            for value in values:
                if option.name not in UNLIMITED or value in ("nan", "abc", "", "-inf"):
                    yield (*good, f"{option.opts[0]}={value}")


#: Paths at which nothing can be written, or where something else is.
NO_OUTPUTS = (
    "nowhere/new", "folder", "log.csv", "log.csv.sidecar.toml", "p.toml", "/dev/full",
    "/proc/new", "n" * 300, "notes.txt", "folder/kept.txt", "other.csv",
)  # fmt: skip


def outputs() -> Iterator[Row]:
    """Every output of every command at such paths, and with other endings."""
    for name, good in GOOD.items():
        for option in command_of(name).params:
            if not isinstance(option.type, Output) or option.type.kind == "folder":
                continue
            words = _without(good, option)
            for path in NO_OUTPUTS:
                beginning = option.type.paths(path)[0] != path
                if beginning and path in ("folder", "log.csv", "notes.txt", "other.csv", "p.toml"):
                    continue
                if beginning and path in ("log.csv.sidecar.toml", "folder/kept.txt"):
                    continue
                yield (*words, option.opts[0], path)
                for ending in option.type.endings[:1]:
                    if path in ("nowhere/new", "folder", "/proc/new"):
                        yield (*words, option.opts[0], f"{path}{ending}/x{ending}")


def _without(good: Row, option: click.Parameter) -> Row:
    """A call without an option that it has already."""
    for flag in option.opts:
        if flag in good:
            place = good.index(flag)
            return good[:place] + good[place + 2 :]
    return good


_LONG = "+".join(f"c{k}*v" for k in range(400))
FORMULAS = (
    "c1*", "(", ")", "c1*/v", "c1*v)", "((((v", "v v", "1e999*v", "c1*w(v)", "sin()", "sin(v,v,v)",
    "__import__('os')", "c1*v;c2", "c1 if v else 2", "v.real", "[v]", "{v}", "'v'", "c1*vé",
    "c1*\x00v", "c1*\nv*(", _LONG, "(" * 3000 + "v" + ")" * 3000, "9" * 5000 + "*v",
    "=", "= c1*v", "coulomb = c1*v*(", "v=v=v", "-" * 5000 + "v",
)  # fmt: skip
SPECS = (
    "", "+", "coulomb+", "+coulomb", "coulomb++load", "coulomb+coulomb", "COULOMBE", "coulomb load",
    "nope", "coulomb+nope", "c" * 100_000, "coulomb\x00", "../coulomb", "coulomb+load+load", "☃",
    "lugre+presliding", "\x1b[2J", "coulomb\nfit", "nope.toml", "folder/none.toml", ".", "/",
)  # fmt: skip
CHOICES = (
    ("--start", "x"), ("--start", "a2="), ("--start", "=1"), ("--start", "a2=nan"),
    ("--start", "a2=abc"), ("--start", "nope=1"), ("--bound", "a2"), ("--bound", "a2=1"),
    ("--bound", "a2=2:1"), ("--bound", "a2=nan:1"), ("--bound", "a2=a:b"), ("--bound", "a2=1:2:3"),
    ("--fix", "a2=inf"), ("--fix", "a2"), ("--fix", "nope=1"), ("--prior", "a2=1"),
    ("--prior", "a2=1+-0"), ("--prior", "a2=1+--1"), ("--prior", "a2=nan+-1"),
    ("--constraint", "a2"), ("--constraint", "a2 >="), ("--constraint", "a2 >= nope"),
    ("--constraint", "a2 >= " + "(" * 3000), ("--tie", "a2"), ("--tie", "a2 = a2"),
    ("--tie", "a2 = nope"), ("--tie", "nope = 1"), ("--loss", "nope"), ("--errors", "nope"),
    ("--resamples", "5"), ("--method", "nope"), ("--estimator", "nope"), ("--algorithm", "nope"),
    ("--grid", "x"), ("--effect", "nope"), ("--effect", "e = "), ("--parameter", "c9: rad"),
    ("--law", "c1*v"), ("--weights", "nope"), ("--starts", "0"), ("--starts", "1000000000"),
    ("--seed", "-1"), ("--seed", "9" * 60), ("--nope",), ("--nope", "1"), ("extra", "words"),
)  # fmt: skip
READING = (
    ("--joint", "nope"), ("--joint-kind", "hinge"), ("--unit", "velocity=furlong"),
    ("--unit", "velocity=kg"), ("--unit", "velocity"), ("--unit", "nope=rad/s"),
    ("--map", "velocity"), ("--map", "velocity=nope"), ("--map", "nope=velocity"),
    ("--map", "=x"), ("--derive", "torque"), ("--derive", "torque=nope*2"),
    ("--derive", "torque=("), ("--derive", "torque=" + "(" * 3000), ("--where", "nope == 1"),
    ("--where", "velocity >"), ("--where", "velocity > 1e9"), ("--where", "'"),
    ("--where", "(" * 3000), ("--average", "nope"), ("--rows", "x"), ("--rows", "5:2"),
    ("--sidecar", "nope.toml"), ("--sidecar", "notes.txt"), ("--sidecar", "m.toml"),
    ("--sidecar", "folder"), ("--sidecar", "log.csv"), ("--gear-ratio", "0"),
    ("--torque-constant", "-1"), ("--drive", "nope"), ("--hold-out", "nope"),
    ("--torque-at", "nope"), ("--moving-above", "-1"), ("--moving-above", "1e9"),
)  # fmt: skip


def texts() -> Iterator[Row]:
    """Formulas, specs, statements and reading options."""
    for formula in FORMULAS:
        yield ("fit", "log.csv", "--law", formula)
        yield ("diagnose", "log.csv", "coulomb", "--candidate", f"own = {formula}")
    for spec in SPECS:
        yield ("fit", "log.csv", "--model", spec)
        yield ("check", spec)
        yield ("improve", "log.csv", "--base", spec)
    for words in CHOICES:
        yield (*GOOD["fit"], *words)
    for words in READING:
        yield (*GOOD["fit"], *words)


OTHER: tuple[Row, ...] = (
    ("improv", "log.csv"), ("fit",), ("fit", "log.csv"), ("fit", "nope.csv", "--model", "coulomb"),
    ("fit", "folder", "--model", "coulomb"), ("fit", "notes.txt", "--model", "coulomb"),
    ("fit", "n" * 5000 + ".csv", "--model", "coulomb"), ("fit", "*.nope", "--model", "coulomb"),
    ("fit", "log.csv\x00", "--model", "coulomb"), ("compare", "log.csv"),
    ("compare", "log.csv", "notes.txt"), ("add", "log.csv", "coulomb"),
    ("add", "log.csv", "coulomb", "nope"), ("add", "log.csv", "coulomb", "stribeck", "load"),
    ("improve", "log.csv", "--reject", "nope"), ("improve", "log.csv", "--max-steps", "-1"),
    ("diagnose", "log.csv", "coulomb", "coulomb"), ("diagnose", "log.csv", "--least-fall", "1.1"),
    ("diagnose", "log.csv", "coulomb", "--least-fall", "-0.1"),
    ("diagnose", "log.csv", "coulomb", "--sample-rows", "5"),
    ("diagnose", "log.csv", "coulomb", "--figures", "log.csv"),
    ("diagnose", "log.csv", "coulomb", "--figures", "nowhere/new"),
    ("improve", "log.csv", "-o", "new.html", "--report", "new.html"),
    ("check", "m.toml", "--box", "velocity"), ("check", "m.toml", "--box", "velocity=1:-1"),
    ("check", "m.toml", "--box", "velocity=nan:1"), ("check", "m.toml", "--box", "nope=0:1"),
    ("check", "m.toml", "--box", "temperature=-300:20"),
    ("simulate", "warm.toml", "--inertia", "1", "--temperature", "-300"),
    ("compensate", "warm.toml", "--inertia", "1", "--temperature", "-273.2"),
    ("export", "warm.toml", "--to", "c", "new", "--box", "temperature=-274:20"),
    ("check", "m.toml", "--box", "velocity=a:b"), ("check", "m.toml", "--box", "=:"),
    ("export", "m.toml", "--to", "cobol", "new"), ("export", "m.toml", "--to", "c", "notes.txt"),
    ("export", "m.toml", "--to", "c", "folder", "--name", "own"),
    ("export", "m.toml", "--to", "c", "nowhere\x00"),
    ("export", "m.toml", "--to", "c", "new", "--precision", "half"),
    ("export", "m.toml", "--to", "c", "new", "--box", "velocity=inf:nan"),
    ("export", "m.toml", "--to", "c", "new", "--box", "velocity=1:1e999"),
    ("export", "m.toml", "--to", "rust", "new", "--libm"), ("export", "lugre", "--to", "c", "new"),
    ("simulate", "nope", "--inertia", "1"), ("simulate", "coulomb", "--inertia", "1"),
    ("simulate", "m.toml"), ("simulate", "m.toml", "--inertia", "1", "--mass", "1"),
    ("simulate", "m.toml", "--inertia", "0"), ("simulate", "m.toml", "--inertia", "-1"),
    ("simulate", "m.toml", "--inertia", "1", "--bandwidth", "1e90"),
    ("simulate", "m.toml", "--inertia", "1", "--step", "1e-99"),
    ("simulate", "coulomb", "--inertia", "1", "--value", "a2=nan"),
    ("simulate", "coulomb", "--inertia", "1", "--value", "a2"),
    ("compensate", "m.toml", "--inertia", "1", "--factor", "nope"),
    ("compensate", "m.toml", "--inertia", "1", "--factor", "nan"),
    ("compensate", "m.toml", "--inertia", "1", "--factor", "1.5"),
    ("plan", "m.toml", "--position", "1", "--speed", "1", "--acceleration", "1"),
    ("plan", "m.toml", "--position=nan:1", "--speed", "1", "--acceleration", "1", "--show", "load"),
    ("points", "log.csv", "--method", "averaging", "-o", "new.parquet"),
    ("points", "log.csv", "--method", "nope"), ("generate", "-o", "log.csv"),
    ("generate", "-o", "new.txt"), ("generate", "-o", "new.csv", "--effect", "nope"),
    ("generate", "-o", "new.csv", "--law", "nope"), ("generate", "-o", "new.csv", "--test", "3"),
    ("project", "show", "nope.toml"), ("project", "show", "m.toml"), ("project", "show", "log.csv"),
    ("project", "new", "p.toml", "log.csv"), ("project", "new", "nowhere/q.toml", "log.csv"),
    ("project", "new", "new.toml", "nope.csv"), ("project", "back", "p.toml", "99"),
    ("project", "back", "p.toml"), ("project", "add", "p.toml", "nope"),
    ("project", "drop", "p.toml", "load"), ("project", "compare", "p.toml", "1", "9"),
    ("project", "nope"), ("study", "log.csv", "--law", "nope", "-o", "new"),
    ("study", "log.csv", "--workers", "0", "-o", "new"), ("study", "log.csv", "-o", "folder"),
    ("study", "nope.csv", "-o", "new"), ("fleet", "nope.csv", "-o", "new"),
    ("fleet", "*.nope", "-o", "new"), ("fleet", "log.csv", "-o", "folder"),
    ("fleet", "log.csv", "--since", "2020-13-45", "-o", "new"),
    ("inspect", "log.csv", "--write-sidecar"), ("inspect", "nope.csv"), ("models", "extra"),
)  # fmt: skip

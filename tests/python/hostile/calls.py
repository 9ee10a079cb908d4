"""Rows of the Python interface: arguments that are none."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import stribeck as sb

from hostile.contract import Call

NAN, INF, DEEP = math.nan, math.inf, 3000
#: What is neither a model, a fit, a recording, a text nor a path.
STRANGERS: tuple[object, ...] = (None, 3, 2.5, True, b"coulomb", object(), ("coulomb",), {})
#: What no count, and no seed, may be.
NO_COUNTS: tuple[object, ...] = (-1, 2.5, "3", None, True, 10**30, NAN, [1])
NO_SHARES: tuple[object, ...] = (NAN, -0.1, 1.1, INF, "0.5", None, True, [0.5])
#: What no channel may be.
NO_CHANNELS: tuple[object, ...] = (
    None, [NAN], [INF], [[1.0, 2.0]], [1j], [object()], [], "1.0", ["1.0"], b"1", [None],
    np.array(["2020-01-01"], dtype="M8[s]"), np.array([1], dtype="m8[s]"),
    [datetime.datetime(2020, 1, 1)], np.ma.array([1.0, 2.0], mask=[1, 0]), {"v": 1.0},
)  # fmt: skip


@dataclass(frozen=True)
class Kit:
    """Good arguments."""

    folder: Path

    @cached_property
    def recording(self) -> sb.Recording:
        """A recording."""
        return sb.read(str(self.folder / "log.csv"))

    @cached_property
    def fit(self) -> sb.Fit:
        """A fit."""
        return sb.fit("coulomb", self.recording, starts=1)

    @cached_property
    def model(self) -> sb.Model:
        """A model."""
        return sb.model("coulomb", coulomb_friction=1.0, viscous_friction=1.0)


def calls(kit: Kit) -> Iterator[tuple[str, Call]]:
    """Every call, with a name."""
    yield from _strangers(kit)
    yield from _options(kit)
    yield from _choices(kit)
    yield from _channels(kit)
    yield from _models()
    yield from _files(kit)


def _strangers(kit: Kit) -> Iterator[tuple[str, Call]]:
    rec, fit, model = kit.recording, kit.fit, kit.model
    for x in STRANGERS:
        shown = repr(x)[:12]
        yield f"fit {shown}", lambda x=x: sb.fit(x, rec)
        yield f"fit coulomb {shown}", lambda x=x: sb.fit("coulomb", x)
        yield f"diagnose {shown}", lambda x=x: sb.diagnose(x, rec)
        yield f"add {shown}", lambda x=x: sb.add(x, "load", rec)
        yield f"add effect {shown}", lambda x=x: sb.add(fit, x, rec)
        yield f"improve {shown}", lambda x=x: sb.improve(x, rec)
        yield f"improve coulomb {shown}", lambda x=x: sb.improve("coulomb", x)
        yield f"compare {shown}", lambda x=x: sb.compare(x, rec)
        yield f"compare fits {shown}", lambda x=x: sb.compare([x], rec)
        yield f"compare data {shown}", lambda x=x: sb.compare([fit], x)
        yield f"check {shown}", lambda x=x: sb.check(x)
        yield f"export {shown}", lambda x=x: sb.export(x, "c", "new")
        yield f"export to {shown}", lambda x=x: sb.export(model, x, "new")
        yield f"evaluate {shown}", lambda x=x: sb.evaluate(x, rec)
        yield f"simulate {shown}", lambda x=x: sb.simulate(x, None, None)
        yield f"with effect {shown}", lambda x=x: model.with_effect(x, {})
        yield f"value {shown}", lambda x=x: model.value(x)
        if x != b"coulomb":
            yield f"load {shown}", lambda x=x: sb.load(x)
            yield f"save {shown}", lambda x=x: model.save(x)
            yield f"project {shown}", lambda x=x: sb.project(x)
        yield f"model {shown}", lambda x=x: sb.model(x)
        yield f"law {shown}", lambda x=x: sb.law(x)
        yield f"published {shown}", lambda x=x: sb.published(x)
        yield f"plot data {shown}", lambda x=x: sb.plot(x, fit)
        yield f"plot models {shown}", lambda x=x: sb.plot(rec, [x])
        yield f"plot what {shown}", lambda x=x: sb.plot(rec, fit, x)
        yield f"arm inertia {shown}", lambda x=x: _arm(x)
        if x is not None and x != {}:
            yield f"box {shown}", lambda x=x: sb.check(model, box=x)
            yield f"side {shown}", lambda x=x: sb.check(model, box={"velocity": x})
            yield f"channel {shown}", lambda x=x: sb.check(model, box={x: (-1.0, 1.0)})


def _arm(inertia: object) -> object:
    rest = [[0.0, 0.0]]
    return sb.planar_arm_load(inertia, rest, rest, rest, first_link_length=0.3)


def _options(kit: Kit) -> Iterator[tuple[str, Call]]:
    rec, fit, model = kit.recording, kit.fit, kit.model
    for n in NO_COUNTS:
        yield f"starts {n!r}", lambda n=n: sb.fit("coulomb", rec, starts=n)
        yield f"seed {n!r}", lambda n=n: sb.fit("coulomb", rec, seed=n)
        yield f"export seed {n!r}", lambda n=n: sb.export(model, "c", "new", seed=n)
        yield f"most steps {n!r}", lambda n=n: sb.improve("coulomb", rec, most_steps=n)
        yield f"sample rows {n!r}", lambda n=n: sb.diagnose(fit, sample_rows=n)
        yield f"improve starts {n!r}", lambda n=n: sb.improve("coulomb", rec, starts=n)
        yield (
            f"resamples {n!r}",
            lambda n=n: sb.fit("coulomb", rec, errors="bootstrap", resamples=n),
        )
    yield "starts 0", lambda: sb.fit("coulomb", rec, starts=0)
    for share in NO_SHARES:
        yield f"least fall {share!r}", lambda share=share: sb.diagnose(fit, least_fall=share)
        yield (
            f"improve least fall {share!r}",
            lambda share=share: sb.improve("coulomb", rec, least_fall=share),
        )
    for text in ("nope", None, 3, b"x"):
        for name in ("loss", "algorithm", "estimator", "errors"):
            if not (text is None and name in ("loss", "algorithm")):
                yield (
                    f"{name} {text!r}",
                    lambda name=name, text=text: sb.fit("coulomb", rec, **{name: text}),
                )
        if text is not None:
            yield f"reading {text!r}", lambda text=text: sb.read("log.csv", joint_kind=text)
    for listed in ("load", 3, [3], [None], ["nope"]):
        yield (
            f"rejected {listed}",
            lambda listed=listed: sb.improve("coulomb", rec, rejected=listed),
        )
        yield f"candidates {listed}", lambda x=listed: sb.diagnose(fit, candidates=x)


def _choices(kit: Kit) -> Iterator[tuple[str, Call]]:
    rec = kit.recording
    name = "coulomb_friction"
    wrong: dict[str, tuple[object, ...]] = {
        "fix": (3, {name: NAN}, {name: "x"}, {name: None}, {3: 1.0}, {"nope": 1.0}, [3], "x"),
        "start": (3, {name: INF}, {name: "x"}, {"nope": 1.0}, [None], "="),
        "bounds": (3, {name: 3}, {name: (NAN, 1)}, {name: (2, 1)}, {name: (1,)}, {name: "ab"}),
        "prior": (3, {name: (1, 0)}, {name: (1, NAN)}, {name: 1}, {name: (1, -1)}, "a=1"),
        "constraints": (3, [3], "a2", "a2 >=", ["nope >= 1"], "a2 >= " + "(" * DEEP),
        "ties": (3, {name: 3}, {name: "nope"}, {name: name}, {name: "(" * DEEP}, "x"),
        "weights": (3, "x", [1.0], [NAN] * 1200, [-1.0] * 1200),
    }
    for option, values in wrong.items():
        for value in values:
            yield (
                f"{option} {str(value)[:20]}",
                lambda option=option, value=value: sb.fit("coulomb", rec, **{option: value}),
            )


def _channels(kit: Kit) -> Iterator[tuple[str, Call]]:
    model, lugre = kit.model, sb.model(
        "lugre",
        **dict.fromkeys(sb.model("lugre").names, 1.0),
    )  # fmt: skip
    for number, wrong in enumerate(NO_CHANNELS):
        yield f"velocity {number}", lambda wrong=wrong: model.torque(wrong)
        yield f"gradient {number}", lambda wrong=wrong: model.gradient(wrong)
        # Not None, and not what a channel that is not read may hold.
        if number > 2:
            yield f"position {number}", lambda wrong=wrong: model.torque([1.0], position=wrong)
            yield f"dt {number}", lambda wrong=wrong: lugre.torque([1.0], dt=wrong)
    yield "lengths", lambda: model.torque([1.0], position=[1.0, 2.0])
    for precision in ("half", None, 3):
        yield f"precision {precision}", lambda p=precision: model.torque([1.0], precision=p)


def _models() -> Iterator[tuple[str, Call]]:
    for value in (NAN, INF, "x", None, [1, 2], 1j, True, 10**400):
        yield f"value {str(value)[:9]}", lambda v=value: sb.model("coulomb", coulomb_friction=v)
    yield "given twice", lambda: sb.model("coulomb", coulomb_friction=1.0, a2=2.0)
    yield "unknown", lambda: sb.model("coulomb", nope=1.0)
    yield "no values", lambda: sb.model("coulomb").torque([1.0])
    for inertia in (NAN, INF, 0.0, -1.0, "x", None, 1e300, True):
        yield f"inertia {inertia}", lambda inertia=inertia: sb.Joint(inertia)


def _files(kit: Kit) -> Iterator[tuple[str, Call]]:
    model = kit.model
    names = ("", ".", "folder", "nowhere/new", "n" * 300, "a\0b", "/dev/full", "log.csv")
    for name in names:
        yield f"save {name[:20]!r}", lambda name=name: model.save(name)
        yield f"load {name[:20]!r}", lambda name=name: sb.load(name)
        if name not in ("log.csv", "."):
            yield f"read {name[:20]!r}", lambda name=name: sb.read(name)
    for name in ("notes.txt/new", "notes.txt", "a\0b", "n" * 300):
        yield f"export {name[:20]!r}", lambda name=name: sb.export(model, "c", name)
    yield "no such option", lambda: sb.read("log.csv", nope=1)
    for option in ("map", "unit", "where", "joint", "average", "gear_ratio", "unwrap", "sidecar"):
        for value in (3, object(), [3], NAN):
            if not (option == "gear_ratio" and value == 3):
                yield f"{option} {value}", lambda o=option, v=value: sb.read("log.csv", **{o: v})

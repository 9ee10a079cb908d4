"""The recordings of the benchmark.

They contain each effect alone in three sizes, two or three effects together, no effect, motions
that cannot show an effect, effects outside the library, and autocorrelated noise for the confidence
intervals. Those of the first three kinds may have nuisances.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace

from stribeck.base.errors import StribeckError, nearest
from stribeck.benchmark.distortion import distorted, drawn
from stribeck.benchmark.generators import GENERATORS, Generator
from stribeck.benchmark.nuisances.table import NUISANCES
from stribeck.benchmark.sample import Sample
from stribeck.benchmark.sealed.table import SEALED

#: Size of a single effect relative to the noise.
SIZES = (5.0, 1.0, 0.3)
#: Size of each of several effects, and of one outside the library.
SIZE_OF_SEVERAL = 2.0
SIZE_OUTSIDE = 3.0

PAIRS = (
    ("load", "stribeck"),
    ("stribeck", "temperature_viscous"),
    ("load", "temperature_viscous"),
    ("position", "temperature_dry"),
    ("offset", "load"),
    ("inertia", "stribeck"),
    ("gravity", "temperature_viscous"),
    ("direction", "stribeck"),
    ("nonlinear_viscous", "temperature_dry"),
    ("gain", "load"),
    ("spring", "stribeck"),
    ("ripple", "position"),
    ("drift", "temperature_dry"),
    ("saturation", "temperature_viscous"),
    ("presliding", "load"),
)
TRIPLES = (
    ("stribeck", "load", "temperature_viscous"),
    ("offset", "position", "temperature_dry"),
    ("inertia", "stribeck", "drift"),
    ("ripple", "load", "temperature_viscous"),
    ("spring", "stribeck", "temperature_dry"),
    ("gravity", "nonlinear_viscous", "position"),
)
#: Hidden in a limited motion: no effect, one that it cannot show, or one that it can.
HIDDEN_IN_LIMITED = {
    "isothermal": ("none", "temperature_dry", "load"),
    "one_direction": ("none", "direction", "load"),
    "constant_load": ("none", "load", "stribeck"),
    "no_slow_motion": ("none", "stribeck", "load"),
    "warm_up_only": ("none", "drift", "load"),
    "short_range": ("none", "load"),
}
#: Number of recordings without an effect, per generator and seed.
NONE_PER_SEED = 4
#: Number of recordings for the coverage of intervals, per correlation and seed.
COVERAGE_PER_SEED = 20
CORRELATIONS = (0.0, 0.9, 0.99)
AUTOREGRESSIVE = "autoregressive"

#: Groups whose recordings may have nuisances, and the largest number of nuisances in one.
WITH_NUISANCES = ("one", "two", "three", "none")
MOST_NUISANCES = 3

#: Channels that follow from others, and that a logger may not record.
DERIVABLE = ("velocity", "acceleration")

#: Smaller seeds are used by the tests, so that the recordings of the benchmark are independent.
FIRST_SEED = 100_000


@dataclass(frozen=True)
class Case:
    """One recording of the benchmark.

    Attributes
    ----------
    group : {"one", "two", "three", "none", "limited", "outside", "coverage"}
    correlation
        Autocorrelation of the noise at lag one, in the group "coverage".
    quick
        Whether it belongs to the subset that runs in minutes.
    nuisances
        What the bench adds, by name.
    without
        Channels that are not recorded.
    """

    group: str
    generator: str
    effects: tuple[str, ...]
    seed: int
    size: float = 0.0
    limit: str | None = None
    correlation: float | None = None
    quick: bool = False
    nuisances: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """A unique name."""
        parts = [self.generator, self.limit, "+".join(self.effects)]
        if self.size:
            parts.append(f"{self.size:g}x")
        if self.correlation is not None:
            parts.append(f"rho{self.correlation:g}")
        parts.append("+".join(self.nuisances))
        parts += [f"no_{channel}" for channel in self.without]
        return "-".join([p for p in parts if p] + [str(self.seed)])

    def make(self) -> Sample:
        """Generate the recording and its truth."""
        limits = {self.limit: True} if self.limit else {}
        made = GENERATORS[self.generator].make(self.effects, self.seed, self.size, **limits)
        if self.nuisances:
            made = distorted(made, self.nuisances, self.seed)
        return replace(made, frame=made.frame.drop(self.without))


def cases(
    seeds: int = 10,
    *,
    generators: Iterable[str] = tuple(GENERATORS),
    only: str | None = None,
    quick: bool = False,
    seed: int = 0,
    realism: int = 0,
    nuisance: str | None = None,
    sealed: bool = False,
    without: Iterable[str] = (),
) -> list[Case]:
    """Return the cases to run.

    Parameters
    ----------
    seeds : int
        Number of recordings of each kind; the full benchmark has 10.
    generators
        Names in `GENERATORS`.
    only
        A group, an effect, a limit, or part of a case's name.
    quick
        Only the subset that runs in minutes.
    seed
        Seed of all recordings.
    realism
        Number of nuisances in each recording of the groups `WITH_NUISANCES`; the other groups are
        left out then.
    nuisance
        One that every recording has; the others are drawn.
    sealed
        Draw from the sealed nuisances.
    without
        Channels that are not recorded, of `DERIVABLE`.

    Raises
    ------
    StribeckError
        A generator, a nuisance or a channel is unknown, `only` matches no case, or the seed is
        negative.
    """
    names = tuple(generators)
    for name in names:
        if name not in GENERATORS:
            raise StribeckError(
                f"there is no generator {name!r}{nearest(name, GENERATORS)}; "
                f"there are {', '.join(GENERATORS)}"
            )
    if seed < 0:
        raise StribeckError(f"the seed is {seed}: give 0 or a positive whole number")
    first = FIRST_SEED + 1_000_000 * seed
    made = [c for n in names for c in _of_generator(GENERATORS[n], seeds, first)]
    made += _coverage(seeds, first)
    made = [c for c in made if c.quick or not quick]
    made = _with_nuisances(made, realism, nuisance, SEALED if sealed else NUISANCES)
    made = _without(made, tuple(dict.fromkeys(without)))
    return made if only is None else _named(made, only)


def _named(made: list[Case], only: str) -> list[Case]:
    """The cases of a group, an effect or a limit, or else those with `only` in their name."""
    exact = [c for c in made if only in (c.group, c.limit, c.generator) or c.effects == (only,)]
    found = exact or [c for c in made if only in c.name]
    if not found:
        raise StribeckError(
            f"no case has {only!r} in its name: give a group (one, two, three, none, limited, "
            f"outside, coverage), an effect, a limit of the motion, or part of a case's name"
        )
    return found


def _with_nuisances(
    made: list[Case], realism: int, nuisance: str | None, pool: Collection[str]
) -> list[Case]:
    """The cases that may have nuisances, each with as many as asked for."""
    if nuisance is not None and nuisance not in pool:
        raise StribeckError(
            f"there is no nuisance {nuisance!r}{nearest(nuisance, pool)}; "
            f"there are {', '.join(pool)}"
        )
    if not 0 <= realism <= MOST_NUISANCES:
        raise StribeckError(f"realism is {realism}: give 0 to {MOST_NUISANCES}")
    fixed = () if nuisance is None else (nuisance,)
    count = max(realism, len(fixed), int(pool is SEALED))
    if count == 0:
        return made
    return [
        replace(c, nuisances=drawn(pool, count, c.seed, fixed))
        for c in made
        if c.group in WITH_NUISANCES
    ]


def _without(made: list[Case], channels: tuple[str, ...]) -> list[Case]:
    """The cases without some channels; those that generate no recording are left out then."""
    for channel in channels:
        if channel not in DERIVABLE:
            raise StribeckError(
                f"{channel!r} cannot be left out{nearest(channel, DERIVABLE)}: "
                f"give {' or '.join(DERIVABLE)}"
            )
    if not channels:
        return made
    return [replace(c, without=channels) for c in made if c.generator in GENERATORS]


def _of_generator(generator: Generator, seeds: int, first: int) -> Iterator[Case]:
    name = generator.name
    numbered = _Seeds(first)
    for size in SIZES:
        for effect in generator.effects:
            for k, seed in enumerate(numbered.next(seeds)):
                yield Case("one", name, (effect,), seed, size, quick=k == 0 and size == 1.0)
    for group, sets in (("two", PAIRS), ("three", TRIPLES)):
        for i, effects in enumerate(sets):
            drawn = numbered.next(seeds)
            if set(effects) <= set(generator.effects):
                for k, seed in enumerate(drawn):
                    quick = k == 0 and i < 2
                    yield Case(group, name, effects, seed, SIZE_OF_SEVERAL, quick=quick)
    for k, seed in enumerate(numbered.next(NONE_PER_SEED * seeds)):
        yield Case("none", name, ("none",), seed, quick=k < 3)
    for limit in generator.limits:
        for effect in HIDDEN_IN_LIMITED[limit]:
            for k, seed in enumerate(numbered.next(seeds)):
                quick = k == 0 and effect == "none"
                yield Case("limited", name, (effect,), seed, 1.0, limit, quick=quick)
    for effect in generator.outside:
        for k, seed in enumerate(numbered.next(seeds)):
            yield Case("outside", name, (effect,), seed, SIZE_OUTSIDE, quick=k == 0)


class _Seeds:
    """Seeds that are independent of the number of recordings of a kind."""

    #: Largest number of recordings of one kind.
    ROOM = 1000

    def __init__(self, first: int) -> None:
        self._next = first

    def next(self, count: int) -> range:
        """The first `count` seeds of the next kind."""
        start = self._next
        self._next += self.ROOM
        return range(start, start + count)


def _coverage(seeds: int, first: int) -> Iterator[Case]:
    for correlation in CORRELATIONS:
        for k in range(COVERAGE_PER_SEED * seeds):
            law = ("coulomb", "stribeck")[k % 2]
            yield Case(
                "coverage",
                AUTOREGRESSIVE,
                (law,),
                first + k,
                correlation=correlation,
                quick=k < 10,
            )

"""A chain of moves."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from stribeck.benchmark.open_loop.moves import Array, Move


@dataclass
class MoveChain:
    """A sequence of moves, each an analytic function of time, at rest before and after."""

    starts: list[float] = field(default_factory=list)
    moves: list[Move] = field(default_factory=list)
    origins: list[float] = field(default_factory=list)
    end: float = 0.0
    q: float = 0.0

    def add(self, duration: float, move: Move, advance: float) -> None:
        """Append a move that lasts `duration` and ends `advance` further on, at rest."""
        self.starts.append(self.end)
        self.moves.append(move)
        self.origins.append(self.q)
        self.end += duration
        self.q += advance

    def rest(self, duration: float) -> None:
        """Append a dwell."""
        self.add(duration, lambda t: (0 * t, 0 * t, 0 * t), 0.0)

    def __call__(self, t: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at sorted times `t`."""
        q, v, a = np.full_like(t, self.q), np.zeros_like(t), np.zeros_like(t)
        edges = np.searchsorted(t, [*self.starts, self.end])
        q[: edges[0]] = self.origins[0]
        for i, move in enumerate(self.moves):
            rows = slice(edges[i], edges[i + 1])
            if rows.stop > rows.start:
                dq, v[rows], a[rows] = move(t[rows] - self.starts[i])
                q[rows] = self.origins[i] + dq
        return q, v, a

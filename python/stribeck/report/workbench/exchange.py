"""Results between the workbench and its working process.

A recording, or a fit with the torque of every sample, crosses once: what the other side has already
is named and not copied, and comes back as the same object.
"""

from __future__ import annotations

import io
import pickle
from typing import TYPE_CHECKING

from stribeck.fitting.result import Fit
from stribeck.recording.recording import Recording

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

#: Objects that are named once both sides have them.
LARGE = (Recording, Fit)


class Exchange:
    """One end of a connection.

    Parameters
    ----------
    connection
        To the other process.
    side
        A letter; the two ends have different ones.
    """

    def __init__(self, connection: Connection, side: str) -> None:
        self._connection = connection
        self._side = side
        self._objects: dict[str, object] = {}
        self._names: dict[int, str] = {}

    def send(self, message: object) -> None:
        """Send any object that can be pickled."""
        self._connection.send_bytes(self.dumps(message))

    def receive(self) -> object:
        """Wait for the next message.

        Raises
        ------
        EOFError
            The other process has ended.
        """
        return self.loads(self._connection.recv_bytes())

    def dumps(self, message: object, root: object = None) -> bytes:
        """Pickle a message; `root` is written out even if it is large."""
        stream = io.BytesIO()
        _Writer(self, stream, root).dump(message)
        return stream.getvalue()

    def loads(self, content: bytes) -> object:
        """The message of `dumps` of the other side."""
        return _Reader(self, io.BytesIO(content)).load()

    def name(self, large: object) -> tuple[str, bytes | None]:
        """The name of a large object, with its content if the other side does not have it."""
        known = self._names.get(id(large))
        if known is not None:
            return known, None
        content = self.dumps(large, large)
        name = f"{self._side}{len(self._objects)}"
        self.keep(name, large)
        return name, content

    def keep(self, name: str, large: object) -> None:
        """Remember an object that both sides have."""
        self._objects[name] = large
        self._names[id(large)] = name

    def find(self, name: str, content: bytes | None) -> object:
        """The object of a name, as the other side wrote it."""
        if content is not None:
            self.keep(name, self.loads(content))
        return self._objects[name]


class _Writer(pickle.Pickler):
    def __init__(self, exchange: Exchange, stream: io.BytesIO, root: object) -> None:
        super().__init__(stream, protocol=5)
        self._exchange = exchange
        self._root = root

    def persistent_id(self, obj: object) -> tuple[str, bytes | None] | None:
        """Name a large object; None: pickle it as usual."""
        if obj is self._root or not isinstance(obj, LARGE):
            return None
        return self._exchange.name(obj)


class _Reader(pickle.Unpickler):
    def __init__(self, exchange: Exchange, stream: io.BytesIO) -> None:
        super().__init__(stream)
        self._exchange = exchange

    def persistent_load(self, pid: tuple[str, bytes | None]) -> object:
        """The object of a name."""
        return self._exchange.find(*pid)

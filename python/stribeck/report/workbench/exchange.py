"""Results between the workbench and its working process.

A recording, or a fit with the torque of every sample, crosses once: what the other side has already
is named and not copied, and comes back as the same object. Arrays follow the message that has them
as messages of their own: they are written from where they lie and read to where they stay.
"""

from __future__ import annotations

import io
import pickle
from collections.abc import Iterator
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
        arrays: list[pickle.PickleBuffer] = []
        content = self.dumps(message, arrays)
        sizes = [array.raw().nbytes for array in arrays]
        self._connection.send_bytes(pickle.dumps((content, sizes)))
        for array in arrays:
            self._connection.send_bytes(array.raw())

    def receive(self) -> object:
        """Wait for the next message.

        Raises
        ------
        EOFError
            The other process has ended.
        """
        content, sizes = pickle.loads(self._connection.recv_bytes())
        arrays = [bytearray(size) for size in sizes]
        for array in arrays:
            self._connection.recv_bytes_into(array)
        return self.loads(content, iter(arrays))

    def dumps(
        self, message: object, arrays: list[pickle.PickleBuffer], root: object = None
    ) -> bytes:
        """Pickle a message without its arrays; `root` is written out even if it is large."""
        stream = io.BytesIO()
        _Writer(self, stream, arrays, root).dump(message)
        return stream.getvalue()

    def loads(self, content: bytes, arrays: Iterator[bytearray]) -> object:
        """The message of `dumps` of the other side."""
        return _Reader(self, io.BytesIO(content), arrays).load()

    def name(self, large: object, arrays: list[pickle.PickleBuffer]) -> tuple[str, bytes | None]:
        """The name of a large object, with its content if the other side does not have it."""
        known = self._names.get(id(large))
        if known is not None:
            return known, None
        content = self.dumps(large, arrays, large)
        name = f"{self._side}{len(self._objects)}"
        self.keep(name, large)
        return name, content

    def keep(self, name: str, large: object) -> None:
        """Remember an object that both sides have."""
        self._objects[name] = large
        self._names[id(large)] = name

    def find(self, name: str, content: bytes | None, arrays: Iterator[bytearray]) -> object:
        """The object of a name, as the other side wrote it."""
        if content is not None:
            self.keep(name, self.loads(content, arrays))
        return self._objects[name]


class _Writer(pickle.Pickler):
    def __init__(
        self,
        exchange: Exchange,
        stream: io.BytesIO,
        arrays: list[pickle.PickleBuffer],
        root: object,
    ) -> None:
        super().__init__(stream, protocol=5, buffer_callback=arrays.append)
        self._exchange = exchange
        self._arrays = arrays
        self._root = root

    def persistent_id(self, obj: object) -> tuple[str, bytes | None] | None:
        """Name a large object; None: pickle it as usual."""
        if obj is self._root or not isinstance(obj, LARGE):
            return None
        return self._exchange.name(obj, self._arrays)


class _Reader(pickle.Unpickler):
    def __init__(self, exchange: Exchange, stream: io.BytesIO, arrays: Iterator[bytearray]) -> None:
        super().__init__(stream, buffers=arrays)
        self._exchange = exchange
        self._arrays = arrays

    def persistent_load(self, pid: tuple[str, bytes | None]) -> object:
        """The object of a name."""
        return self._exchange.find(*pid, self._arrays)

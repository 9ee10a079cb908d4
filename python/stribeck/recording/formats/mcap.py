"""MCAP files: messages of ROS 2, and JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, Entered, missing_library
from stribeck.recording.formats.messages import Topics
from stribeck.recording.formats.part import Read

if TYPE_CHECKING:
    from mcap.records import Channel, Chunk, Message, Schema

__all__ = ["read_mcap"]

#: Largest block of messages, bytes: writers make them of about 1 MB.
_LARGEST_CHUNK = 1 << 28
#: Encodings of messages that are read.
_ENCODINGS = "cdr (ROS 2) and json"


def read_mcap(file: Entered, asked: Asked) -> Read:
    """The topics of an MCAP file, one chunk of it in memory at a time.

    Raises
    ------
    RecordingError
        The file is damaged or too large, has no messages that can be read, or a library is not
        installed.
    """
    try:
        import mcap.stream_reader  # noqa: F401
        import mcap_ros2.decoder  # noqa: F401
    except ImportError:
        raise missing_library(file.name, "MCAP", "mcap and mcap-ros2-support") from None
    try:
        content = _Content()
        topics = Topics(file, _topics(file, content), asked)
        wanted = set(topics.wanted)
        decoders: dict[int, Callable[[bytes], Any]] = {}
        for message in _records(file, content):
            channel = content.channels[message.channel_id]
            if channel.topic not in wanted:
                continue
            decode = decoders.get(channel.id)
            if decode is None:
                decode = decoders[channel.id] = _decoder(file, content, channel)
            topics.add(channel.topic, decode(message.data), message.log_time)
        return topics.read()
    except RecordingError:
        raise
    except Exception as error:  # the libraries raise many kinds on damaged files
        raise file.damaged("MCAP", error, "copy it again, or repair it (mcap recover)") from None


class _Content:
    """Channels and schemas that were met."""

    def __init__(self) -> None:
        self.channels: dict[int, Channel] = {}
        self.schemas: dict[int, Schema] = {}


def _topics(file: Entered, content: _Content) -> dict[str, str]:
    """Topic -> type, from the summary; without one, from the whole file."""
    from mcap.reader import SeekingReader

    with file.open() as stream:
        summary = SeekingReader(stream, record_size_limit=_LARGEST_CHUNK).get_summary()
    if summary is not None and summary.channels:
        content.channels.update(summary.channels)
        content.schemas.update(summary.schemas)
    else:
        for _ in _records(file, content):
            pass
    return {
        c.topic: content.schemas[c.schema_id].name if c.schema_id in content.schemas else "json"
        for c in content.channels.values()
    }


def _records(file: Entered, content: _Content) -> Iterator[Message]:
    """The messages in the order of the file; channels and schemas are entered."""
    from mcap.records import Channel, Chunk, Message, Schema
    from mcap.stream_reader import StreamReader, breakup_chunk

    with file.open() as stream:
        reader = StreamReader(stream, emit_chunks=True, record_size_limit=_LARGEST_CHUNK)
        for record in reader.records:
            inner = [record]
            if isinstance(record, Chunk):
                _check_chunk(record)
                inner = breakup_chunk(record)
            for item in inner:
                if isinstance(item, Message):
                    yield item
                elif isinstance(item, Channel):
                    content.channels[item.id] = item
                elif isinstance(item, Schema):
                    content.schemas[item.id] = item


def _check_chunk(chunk: Chunk) -> None:
    """Refuse a chunk that is larger after decompression than it says, or than any."""
    size = chunk.uncompressed_size
    if chunk.compression == "zstd":
        import zstandard

        held = zstandard.frame_content_size(chunk.data)
        size = max(size, held) if held >= 0 else size
    elif chunk.compression == "lz4":
        import lz4.frame

        size = max(size, int(lz4.frame.get_frame_info(chunk.data)["content_size"]))
        # Without a size in the frame, lz4 goes on as long as there is data: 255 bytes for each.
        size = max(size, min(255 * len(chunk.data), size or 255 * len(chunk.data)))
    if size > _LARGEST_CHUNK:
        raise ValueError(f"a chunk of {size} bytes")


def _decoder(file: Entered, content: _Content, channel: Channel) -> Callable[[bytes], Any]:
    """What decodes the messages of a channel."""
    from mcap_ros2.decoder import DecoderFactory

    if channel.message_encoding == "json":
        return json.loads
    schema = content.schemas.get(channel.schema_id)
    decode = DecoderFactory().decoder_for(channel.message_encoding, schema)
    if decode is None:
        written = f"{channel.message_encoding}, {schema.encoding if schema else 'no'} schema"
        raise RecordingError(
            f"{file.name}: the messages of {channel.topic} are encoded as {written[:60]}; those "
            f"read are {_ENCODINGS}: name a column of another topic, or convert the file"
        )
    return decode

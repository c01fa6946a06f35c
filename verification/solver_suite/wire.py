"""Frames between the judge and the process of a solver: no pickles come back, and no read is without an end.

A frame is the mark, the lengths of both parts, a JSON object and raw bytes. A solver can write whatever it
likes into the descriptors that its process has; what is no frame raises `Garbled`.
"""

from __future__ import annotations

import json
import socket
import struct
import time
from collections.abc import Mapping
from typing import Any

MARK = b"rough\x00\x01\xff"
HEAD = struct.Struct("<8sIQ")
LONGEST_HEADER, LONGEST_BODY = 1 << 16, 1 << 31


class Garbled(Exception):
    """Bytes that are no frame."""


class Late(Exception):
    """No whole frame within the time."""


def send(
    to: socket.socket, header: Mapping[str, Any], body: bytes = b"", *, seconds: float | None = None
) -> None:
    """Write a frame. Raises `Late` where nobody reads it within ``seconds``, OSError where nobody can."""
    text = json.dumps(header).encode()
    to.settimeout(seconds)
    try:
        to.sendall(HEAD.pack(MARK, len(text), len(body)) + text + body)
    except TimeoutError as late:
        raise Late from late


def receive(source: socket.socket, *, seconds: float | None = None) -> tuple[dict[str, Any], bytes]:
    """Read a frame. Raises `Late`, `Garbled`, and EOFError at the end of the stream."""
    deadline = None if seconds is None else time.monotonic() + seconds
    mark, header_length, body_length = HEAD.unpack(_exactly(source, HEAD.size, deadline))
    if mark != MARK or header_length > LONGEST_HEADER or body_length > LONGEST_BODY:
        raise Garbled("no frame")
    try:
        header = json.loads(_exactly(source, header_length, deadline))
    except ValueError as broken:
        raise Garbled(str(broken)) from broken
    if not isinstance(header, dict):
        raise Garbled("a header that is no object")
    return header, _exactly(source, body_length, deadline)


def _exactly(source: socket.socket, length: int, deadline: float | None) -> bytes:
    found = bytearray()
    while len(found) < length:
        left = None if deadline is None else deadline - time.monotonic()
        if left is not None and left <= 0:
            raise Late
        source.settimeout(left)
        try:
            part = source.recv(min(length - len(found), 1 << 20))
        except TimeoutError as late:
            raise Late from late
        if not part:
            raise EOFError
        found += part
    return bytes(found)

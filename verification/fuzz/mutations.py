"""Seeded mutations of valid files: damaged bytes, spliced pieces, tokens that parsers stumble over."""

from __future__ import annotations

import random

TOKENS = tuple(
    token.encode()
    for token in (
        "nan", "-nan", "inf", "-inf", "1e400", "-1e-400", "0", "-0.0", "-1", "1" * 400, "1" * 5000,
        "9" * 19, "true", "''", '""', "[]", "{}", "[[", "]]", "[" * 300, '"""', "'''", "\\", "\\u0000",
        "\\U00110000", "\x00", "\ufeff", "\u2028", "=", "= =", ".", "..", "#", "\n", "\r", "\t",
        "1979-05-27T07:32:00Z", "0x", "0b2", "1__0", "1e", "e1", "kind", 'kind = "measured"',
        'path = "/dev/zero"', 'path = "../../etc/passwd"', 'path = ""', "rms = nan", "seed = -1",
        "seed = 9223372036854775808", "periodic = 1", "[upper.material]", "[[upper.surface]]",
        "[friction]", "side = 1e-300", "load = inf", "nu = 0.5", "nu = -1.0", "terms = [[]]",
        "radius = 1e-320", "grid = [0]", "[vary]", "realisations = 1e9", "scene = 3",
        "<!DOCTYPE x [<!ENTITY a '&a;&a;'>]>", "PK\x03\x04",
    )
)  # fmt: skip


def mutated(valid: bytes, others: tuple[bytes, ...], source: random.Random) -> bytes:
    """``valid`` after one to six random changes; ``others`` are pieces to splice in."""
    data = bytearray(valid)
    for _ in range(source.choice((1, 1, 1, 2, 3, 6))):
        _change(data, others, source)
    return bytes(data)


def _change(data: bytearray, others: tuple[bytes, ...], source: random.Random) -> None:
    at = source.randrange(len(data) + 1)
    end = min(len(data), at + source.choice((1, 2, 4, 8, 64, 1024)))
    kind = source.randrange(9)
    if kind == 0:
        data[at:end] = b""
    elif kind == 1 and at < len(data):
        data[at] ^= 1 << source.randrange(8)
    elif kind == 2:
        data[at:at] = source.choice(TOKENS)
    elif kind == 3:
        data[at:end] = source.choice(TOKENS)
    elif kind == 4:
        del data[at:]
    elif kind == 5:
        data[at:at] = data[at:end] * source.choice((1, 2, 50))
    elif kind == 6:
        data[at:end] = source.randbytes(end - at)
    elif kind == 7:
        other = source.choice(others)
        start = source.randrange(len(other) + 1)
        data[at:end] = other[start : start + source.choice((4, 32, 256))]
    else:
        _change_number(data, source)


def _change_number(data: bytearray, source: random.Random) -> None:
    """Another value where a value stands: after a randomly chosen ``=``."""
    equals = [k for k, byte in enumerate(data) if byte == ord("=")]
    if equals:
        at = source.choice(equals) + 1
        end = data.find(b"\n", at)
        data[at : end if end >= 0 else len(data)] = b" " + source.choice(TOKENS)

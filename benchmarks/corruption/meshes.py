"""Corruptions of one mesh file of a model. Each changes the file at a path in place."""

from __future__ import annotations

import os
import struct
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Random = np.random.Generator
    Corruption = Callable[[Path, Random], None]

_WORDS = ("nan", "inf", "1e308", "-1e39", "", "x", "1e400", "0", "9" * 400)
_INDICES = ("0", "-1", "-9999999", "999999999", "99999999999999999999", "2147483648", "1/", "x", "")
_BOX_OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def flip_bits(path: Path, random: Random) -> None:
    """Turn over one to twenty bits."""
    content = bytearray(path.read_bytes())
    for place in random.integers(len(content), size=random.integers(1, 21)):
        content[place] ^= 1 << int(random.integers(8))
    path.write_bytes(bytes(content))


def flip_header_bits(path: Path, random: Random) -> None:
    """Turn over bits of the first 200 bytes, where counts and lengths stand."""
    content = bytearray(path.read_bytes())
    for place in random.integers(min(200, len(content)), size=random.integers(1, 9)):
        content[place] ^= 1 << int(random.integers(8))
    path.write_bytes(bytes(content))


def cut_end(path: Path, random: Random) -> None:
    """Keep the beginning only."""
    content = path.read_bytes()
    path.write_bytes(content[: int(random.integers(len(content)))])


def drop_bytes(path: Path, random: Random) -> None:
    """Leave out a stretch."""
    content = path.read_bytes()
    start = int(random.integers(len(content)))
    path.write_bytes(content[:start] + content[start + int(random.integers(1, 400)) :])


def replace_content(path: Path, random: Random) -> None:
    """Put something else under the same name."""
    contents = (
        b"", b"\x00", b"\x00" * 84, b"solid\nendsolid\n", b"<robot/>", random.bytes(5000), b"v 0 0 0\n", b"f 1 2 3\n",
        b"glTF" + struct.pack("<II", 2, 2**31), bytes(80) + struct.pack("<I", 2**32 - 1) + bytes(50),
        b"ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n", b"OFF\n99999999 1 0\n",
        b"PK\x03\x04" + random.bytes(100), b"<COLLADA/>", b"[" * 100_000, _BOX_OBJ,
    )  # fmt: skip
    path.write_bytes(contents[int(random.integers(len(contents)))])


def no_plain_file(path: Path, random: Random) -> None:
    """Put a folder, a pipe, a device, a link in a circle or a file of 2 GB in its place."""
    path.unlink()
    kind = int(random.integers(6))
    if kind == 0:
        path.mkdir()
    elif kind == 1:
        os.mkfifo(path)
    elif kind == 2:
        path.symlink_to("/dev/zero")
    elif kind == 3:
        path.symlink_to(path)
    elif kind == 4:
        with path.open("wb") as file:
            file.truncate(2**31)
    # else: it is missing


def _lines(path: Path, random: Random, keyword: bytes) -> tuple[list[bytes], int]:
    """Lines of an OBJ and the number of one that begins with the keyword; -1 where it is no OBJ."""
    lines = path.read_bytes().split(b"\n")
    places = [k for k, line in enumerate(lines) if line.startswith(keyword + b" ")]
    return lines, places[int(random.integers(len(places)))] if places else -1


def wrong_index(path: Path, random: Random) -> None:
    """Let a face of an OBJ refer to a vertex that is not there; other formats lose bytes."""
    lines, place = _lines(path, random, b"f")
    if place < 0:
        drop_bytes(path, random)
        return
    words = lines[place].split()
    words[int(random.integers(1, len(words)))] = str(random.choice(_INDICES)).encode()
    lines[place] = b" ".join(words)
    path.write_bytes(b"\n".join(lines))


def wrong_coordinate(path: Path, random: Random) -> None:
    """Write something else for a coordinate of an OBJ; of other formats, NaN over some bytes."""
    lines, place = _lines(path, random, b"v")
    if place < 0:
        content = bytearray(path.read_bytes())
        start = int(random.integers(len(content)))
        content[start : start + 4] = np.float32(random.choice([np.nan, np.inf, 3e38])).tobytes()
        path.write_bytes(bytes(content))
        return
    words = lines[place].split()
    words[int(random.integers(1, len(words)))] = str(random.choice(_WORDS)).encode()
    lines[place] = b" ".join(words)
    path.write_bytes(b"\n".join(lines))


CORRUPTIONS: dict[str, Corruption] = {
    "mesh: bits flipped": flip_bits,
    "mesh: bits of the header flipped": flip_header_bits,
    "mesh: end cut off": cut_end,
    "mesh: bytes dropped": drop_bytes,
    "mesh: other content": replace_content,
    "mesh: no plain file": no_plain_file,
    "mesh: wrong index": wrong_index,
    "mesh: wrong coordinate": wrong_coordinate,
}

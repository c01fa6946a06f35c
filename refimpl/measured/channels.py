"""Which channel of a file is the map: by its name or number, by default that of heights."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.measured.reading import MAX_POINTS, Overrides

ARRAYS = ("npz", "mat", "h5")  # formats whose arrays may be anything
HEIGHTS = ("z", "h", "height", "heights", "topography", "surface")


def choose(path: Path, form: str, reader: Any, given: Overrides) -> tuple[int, Any]:
    """The channel of the given name or number, by default the first map of heights from the library's own.

    Of several arrays it is the only one that is named as heights are. Raises InputError with all there are.
    """
    channels = list(reader.channels)
    names = [str(c.name) for c in channels]
    listed = ", ".join(f"{k} {name!r}" for k, name in enumerate(names))
    if given.channel is None:
        index = _default(channels, reader, form in ARRAYS)
        if index is None:
            raise InputError("path", str(path), f"a map of heights (found: {listed or 'no channel'})")
        if index < 0:
            raise InputError("channel", None, f"the one that is heights in {path.name}: {listed}")
    elif isinstance(given.channel, int):
        index = given.channel
    else:
        index = next((k for k, name in enumerate(names) if name.casefold() == given.channel.casefold()), -1)
    if not 0 <= index < len(channels):
        raise InputError("channel", given.channel, f"a channel of {path.name}: {listed}")
    channel = channels[index]
    if channel.dim != 2 or not channel.is_uniform:
        what = "a line scan" if channel.dim == 1 else "no regular map"
        raise InputError("path", str(path), f"a map of heights (channel {names[index]!r} is {what})")
    if not _is_height(channel):
        raise InputError("channel", given.channel, f"a channel of heights in {path.name}: {listed}")
    if math.prod(channel.nb_grid_pts) > MAX_POINTS:
        raise InputError("path", str(path), f"heights on a grid of at most {MAX_POINTS} points")
    return index, channel


def _default(channels: list[Any], reader: Any, arrays: bool) -> int | None:
    """Index of the map; None: there is none, -1: several may be."""
    default = reader._default_channel_index
    order = [default, *range(len(channels))] if default < len(channels) else range(len(channels))
    maps = [k for k in order if _is_height(channels[k])]
    if arrays:
        maps = [k for k in dict.fromkeys(maps) if min(channels[k].nb_grid_pts) > 1] or maps
        if len(maps) > 1:
            maps = [k for k in maps if str(channels[k].name).casefold() in HEIGHTS]
            return maps[0] if len(maps) == 1 else -1
    return maps[0] if maps else None


def _is_height(channel: Any) -> bool:
    return channel.dim == 2 and str(getattr(channel.data_kind, "name", "HEIGHT")) == "HEIGHT"


def taken(reader: Any, channel: Any) -> tuple[str, ...]:
    """A note on the channel that was read where there are others."""
    others = ", ".join(repr(str(c.name)) for c in reader.channels if c.name != channel.name)
    return (f"channel {str(channel.name)!r} was read; there are also {others}",) if others else ()


def topography(reader: Any, index: int) -> Any:
    """The library's map of a channel, of pixels of size 1 where the file states none."""
    channel = reader.channels[index]
    given = {} if channel.physical_sizes is not None else {"physical_sizes": channel.nb_grid_pts}
    return reader.topography(channel_index=index, **given)


def with_coordinates(reader: Any, channel: Any) -> Array | None:
    """Points x, y, z of an array Z beside X and Y of its shape, a row or a column of it, as of a meshgrid."""
    indices = {str(c.name).casefold(): k for k, c in enumerate(reader.channels)}
    if str(channel.name).casefold() != "z" or not {"x", "y"} <= set(indices):
        return None
    arrays = [np.ma.filled(topography(reader, indices[name]).heights(), np.nan) for name in "xyz"]
    if not all(n in (1, m) for a in arrays for n, m in zip(a.shape, arrays[-1].shape, strict=True)):
        return None
    return np.stack([a.astype(float).ravel() for a in np.broadcast_arrays(*arrays)], axis=1)

"""Which channel of a file is the map: by its name or number, by default that of heights."""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.measured.reading import MAX_POINTS, Overrides, unreadable

ARRAYS = ("npz", "mat", "h5")  # formats whose arrays may be anything
HEIGHTS = ("z", "h", "height", "heights", "topography", "surface")
NAMES_SHOWN, NAME_SHOWN = 20, 40  # channels in a message, and characters of each


def choose(path: Path, form: str, reader: Any, given: Overrides) -> tuple[int, Any]:
    """Return the channel of a name or number, by default the first map of heights. Raises `InputError`."""
    channels = list(reader.channels)
    names = [str(c.name) for c in channels]
    maps = [] if given.channel is not None else _maps(channels, reader, form in ARRAYS)
    if given.channel is None and not maps and len(names) != 1:
        raise unreadable(path, f"a map of heights (found: {_listed(names) or 'no channel'})")
    sure = maps and (form not in ARRAYS or len(maps) == 1)
    index = maps[0] if sure else chosen(path, names, given.channel)
    channel = channels[index]
    if channel.dim != 2 or not channel.is_uniform:
        what = "a line scan" if channel.dim == 1 else "no regular map"
        raise unreadable(path, f"a map of heights (channel {names[index]!r} is {what})")
    if not _is_height(channel):
        raise InputError("channel", given.channel, f"a channel of heights in {path.name}: {_listed(names)}")
    if math.prod(channel.nb_grid_pts) > MAX_POINTS:
        raise unreadable(path, f"heights on a grid of at most {MAX_POINTS} points")
    return index, channel


def chosen(path: Path, names: list[str], channel: str | int | None) -> int:
    """Return the index of the channel of a name or number; None: the only one. Raises `InputError`."""
    if channel is None and len(names) != 1:
        raise InputError("channel", None, f"the one that is heights in {path.name}: {_listed(names)}")
    if isinstance(channel, str):
        index = next((k for k, name in enumerate(names) if name.casefold() == channel.casefold()), -1)
    else:
        index = channel or 0
    if not 0 <= index < len(names):
        raise InputError("channel", channel, f"a channel of {path.name}: {_listed(names)}")
    return index


def _listed(names: list[str]) -> str:
    """Return the numbers and names, as many and as much of each as a line of a message holds."""
    shown = [f"{k} {name[:NAME_SHOWN]!r}" for k, name in enumerate(names[:NAMES_SHOWN])]
    more = len(names) - len(shown)
    return ", ".join([*shown, f"and {more} more"] if more else shown)


def _maps(channels: list[Any], reader: Any, arrays: bool) -> list[int]:
    """Return the maps of heights, the library's own first; of several arrays those named as heights."""
    default = reader._default_channel_index
    order = [default, *range(len(channels))] if default < len(channels) else range(len(channels))
    maps = [k for k in dict.fromkeys(order) if _is_height(channels[k])]
    if not arrays:
        return maps
    maps = [k for k in maps if min(channels[k].nb_grid_pts) > 1] or maps
    named = [k for k in maps if str(channels[k].name).casefold() in HEIGHTS]
    return named if len(named) == 1 else maps


def is_container(path: Path) -> bool:
    """Return whether the file is an archive with the metadata of contact.engineering."""
    if not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as archive:
        return bool({"meta.yml", "index.json"} & set(archive.namelist()))


def _is_height(channel: Any) -> bool:
    return channel.dim == 2 and str(getattr(channel.data_kind, "name", "HEIGHT")) == "HEIGHT"


def taken(reader: Any, channel: Any) -> tuple[str, ...]:
    """Return a note on the channel that was read where there are others."""
    others = ", ".join(repr(str(c.name)) for c in reader.channels if c.name != channel.name)
    return (f"channel {str(channel.name)!r} was read; there are also {others}",) if others else ()


def topography(reader: Any, index: int) -> Any:
    """Return the library's map of a channel, of pixels of size 1 where the file states none."""
    channel = reader.channels[index]
    given = {} if channel.physical_sizes is not None else {"physical_sizes": channel.nb_grid_pts}
    return reader.topography(channel_index=index, **given)


def with_coordinates(reader: Any, channel: Any) -> Array | None:
    """Return the points x, y, z of an array Z beside X and Y that go with it, as of a meshgrid."""
    indices = {str(c.name).casefold(): k for k, c in enumerate(reader.channels)}
    if str(channel.name).casefold() != "z" or not {"x", "y"} <= set(indices):
        return None
    arrays = [np.ma.filled(topography(reader, indices[name]).heights(), np.nan) for name in "xyz"]
    if not all(n in (1, m) for a in arrays for n, m in zip(a.shape, arrays[-1].shape, strict=True)):
        return None
    return np.stack([a.astype(float).ravel() for a in np.broadcast_arrays(*arrays)], axis=1)

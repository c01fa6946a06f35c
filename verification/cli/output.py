"""Common parts of the subcommands: where output goes, and what is refused."""

from __future__ import annotations

import errno
import itertools
import math
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from verification.output.files import is_stream, to_json, write_text

if TYPE_CHECKING:
    from refimpl import InputError, Scene
    from verification.framework.case import Result

Selected = TypeVar("Selected")


def refusal(field: str, value: object, allowed: str) -> InputError:
    """Return an `InputError`. Its package is imported here, so that --help does not wait for it."""
    from refimpl.errors import InputError

    return InputError(field, value, allowed)


def check_outputs(inputs: Iterable[Path], **outputs: Path | Sequence[Path] | None) -> None:
    """Raise InputError for an output, by its option's name, that would replace a file that is read, or be
    replaced by another option's. Devices and pipes replace nothing; standard output has room for one.
    """
    read = [path for path in inputs if os.path.isfile(path)]  # no shipped scene's name, however long
    written = [
        (option, path)
        for option, paths in outputs.items()
        for path in ([paths] if isinstance(paths, Path) else paths or ())
        if not is_stream(path)
    ]
    for option, path in written:
        if any(_one_file(path, other) for other in read):
            raise refusal(f"--{option}", str(path), "another file than the inputs")
    for (first, path), (option, again) in itertools.combinations(written, 2):
        if option != first and _one_file(path, again):
            raise refusal(f"--{option}", str(again), f"another file than that of --{first}")


def select_or_refuse(only: Sequence[str], select: Callable[[], Selected]) -> Selected:
    """Return what ``select`` finds; raises InputError where the patterns of ``--only`` match no case."""
    try:
        return select()
    except LookupError as nothing:
        raise refusal("--only", only, f"the id of a case ({nothing}; see --list)") from nothing


def check_workers(option: str, count: int) -> None:
    """Raise InputError unless so many worker processes can be started."""
    from refimpl.errors import require_number
    from refimpl.operating_system import MOST_WORKERS

    require_number(option, count, f"1 to {MOST_WORKERS} worker processes", at_least=1, at_most=MOST_WORKERS)


def _one_file(path: Path, other: Path) -> bool:
    if os.path.realpath(path) == os.path.realpath(other):
        return True
    return os.path.isfile(path) and os.path.isfile(other) and os.path.samefile(path, other)


def files_of(scene: Scene) -> list[Path]:
    """Return the files that a scene's surfaces were measured into."""
    from refimpl.measured.measured_surface import MeasuredSurface

    parts = (*scene.upper.surface.parts, *scene.lower.surface.parts)
    return [Path(part.path) for part in parts if isinstance(part, MeasuredSurface)]


def read_or_refuse(option: str, path: Path) -> Any:
    """Return the document of a JSON file; raises InputError, naming the option, for no such file."""
    from refimpl.errors import require_regular
    from verification.output.result_files import MOST_BYTES, read_result

    require_regular(option, path, MOST_BYTES)
    try:
        return read_result(path)
    except FileNotFoundError as missing:
        allowed = "a result file; make one with 'rough-friction verify --json FILE'"
        raise refusal(option, str(path), allowed) from missing
    except OSError as refused:
        raise refusal(option, str(path), f"a file that can be read ({refused.strerror})") from refused
    except (ValueError, RecursionError) as corrupt:  # JSON, UTF-8, or thousands of digits
        raise refusal(option, str(path), f"JSON ({corrupt})") from corrupt


def emit(document: object, path: Path | None, table: str) -> None:
    """Write the document, `plain`, where asked and show the table; '-' prints it in the table's place."""
    document = plain(document)
    if path == Path("-"):
        text = to_json(document)
        try:
            text.encode(sys.stdout.encoding or "utf-8")
        except UnicodeEncodeError:
            text = to_json(document, ascii_only=True)
        show(text.rstrip("\n"))
        return
    try:
        if path is not None:
            write_text(to_json(document), path)
    finally:  # the table is shown even if the file could not be written
        show(table)


def plain(item: object) -> object:
    """Replace NaN and infinity, which JSON does not have, by None.

    >>> plain({"a": [1.0, float("nan")]})
    {'a': [1.0, None]}
    """
    if isinstance(item, Mapping):
        return {key: plain(value) for key, value in item.items()}
    if isinstance(item, list | tuple):
        return [plain(value) for value in item]
    return None if isinstance(item, float) and not math.isfinite(item) else item


def show(text: str) -> None:
    """Print a text, what a terminal would obey escaped.

    Where whoever reads has closed the pipe (on Windows, EINVAL), that and all that follows goes nowhere.
    """
    from refimpl.errors import printable

    try:
        print("\n".join(map(printable, text.split("\n"))), flush=True)
    except OSError as closed:
        if closed.errno not in (errno.EPIPE, errno.EINVAL):
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def judgement(result: Result) -> str:
    """Return the error and tolerance with the sign between them; empty where nothing could be judged."""
    if result.error is None:
        return ""
    sign = ">=" if result.metric == "at_least" else "<="
    sign = sign if result.status == "pass" else {">=": "<", "<=": ">"}[sign]
    return f"{result.error:.3g} {sign} {result.tolerance:.3g}"

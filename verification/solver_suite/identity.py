"""Identity of a solver under test: its version and a checksum, for tables that name it.

That of a Python object is found in the process that runs it, where its package is imported in any case.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from collections.abc import Sequence
from importlib.metadata import Distribution, distribution, packages_distributions

from verification.output.provenance import or_none

Identity = dict[str, str | None]
DIGITS = 16
"""Of a checksum's hexadecimal digits those that are shown."""


def of_files(paths: Sequence[str]) -> str:
    """Return the first `DIGITS` of the SHA-256 over the contents of files, in their order."""
    digest = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            digest.update(hashlib.file_digest(file, "sha256").digest())
    return digest.hexdigest()[:DIGITS]


def of_command(words: Sequence[str]) -> Identity:
    """Return the identity of a program: its own file and the files among its arguments, such as a script."""
    paths = [path for path in (shutil.which(words[0]), *words[1:]) if path and os.path.isfile(path)]
    return {"version": None, "checksum": or_none(lambda: of_files(paths)) if paths else None}


def of_object(module: str, found: object) -> Identity:
    """Return the identity of an object of an imported module; None stands for what cannot be found out.

    A published code has it as attributes; else it is the version of the distribution that installed the
    module's package, and the checksum of the module's file.
    """
    return {
        "version": _text(or_none(lambda: getattr(found, "version", None) or _installed(module))),
        "checksum": _text(or_none(lambda: getattr(found, "checksum", None) or _file(module))),
    }


def _text(found: object) -> str | None:
    return found if isinstance(found, str) else None


def _file(module: str) -> str | None:
    path = sys.modules[module].__file__
    return of_files([path]) if path and os.path.isfile(path) else None


def _installed(module: str) -> str:
    (provider, *_) = packages_distributions()[module.partition(".")[0]]
    return f"{provider} {distribution(provider).version}"


def of_distribution(name: str) -> str | None:
    """Return the checksum of an installed distribution: of its RECORD, which has that of each file."""
    record = or_none(lambda: Distribution.from_name(name).read_text("RECORD"))
    return hashlib.sha256(record.encode()).hexdigest()[:DIGITS] if record else None

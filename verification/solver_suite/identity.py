"""Identity of a solver under test: its name, version and a checksum, for tables that name it."""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import shlex
import shutil
from importlib.metadata import Distribution, PackageNotFoundError, distribution, packages_distributions
from pathlib import Path
from typing import Any

DIGITS = 16
"""Of a checksum's hexadecimal digits those that are shown."""


def of_files(paths: list[Path]) -> str:
    """First `DIGITS` of the SHA-256 over the contents of files, in their order."""
    digest = hashlib.sha256()
    for path in paths:
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()[:DIGITS]


def of_command(command: str) -> dict[str, str | None]:
    """Identity of a program: its own file and the files among its arguments, such as a script."""
    words = shlex.split(command)
    found = shutil.which(words[0])
    paths = [Path(found)] if found else []
    paths += [Path(word) for word in words[1:] if Path(word).is_file()]
    return {"name": command, "version": None, "checksum": of_files(paths) if paths else None}


def of_function(name: str) -> dict[str, str | None]:
    """Identity of ``module:function``, without importing it: the module's own file, and the version of the
    distribution that installed its package. A module that is not found has neither.
    """
    module, top = name.partition(":")[0], name.partition(":")[0].partition(".")[0]
    try:
        spec = importlib.util.find_spec(module)
    except (ImportError, ValueError, AttributeError):
        spec = None
    origin = Path(spec.origin) if spec and spec.origin and Path(spec.origin).is_file() else None
    providers = packages_distributions().get(top, [])
    version = f"{providers[0]} {distribution(providers[0]).version}" if providers else None
    return {"name": name, "version": version, "checksum": of_files([origin]) if origin else None}


def of_distribution(name: str) -> str | None:
    """Checksum of an installed distribution: of its RECORD, which has that of each file; None without one."""
    try:
        record = Distribution.from_name(name).read_text("RECORD")
    except PackageNotFoundError:
        return None
    return hashlib.sha256(record.encode()).hexdigest()[:DIGITS] if record else None


def of_published_code(name: str) -> dict[str, str | None]:
    """Identity of a published code by its adapter, ``module:attribute``: of the code, not of the adapter."""
    module, _, attribute = name.partition(":")
    code: Any = getattr(importlib.import_module(module), attribute)
    return {"name": name, "version": code.version, "checksum": code.checksum}

"""Files and lines behind the errands of a reader: ``python -m tests.errands [FOLDER]``.

``FOLDER`` holds a package ``refimpl`` (by default this project's), so that two states can be compared.
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Iterable
from pathlib import Path

from tests.layers import ROOT, imported_names

READ = {
    "understand how mu is computed": ("model.certificate", "contact.certificate"),
    "believe the reference": ("plain", "solvers.dense"),
}
"""Errands that read a module and all that it imports, by the module's present and former name."""
ATTRIBUTES = {
    "another friction law": {"tau", "beta"},
    "a layered half-space": {"normal_compliance", "shear_compliance"},
    "rectangles: numbers of one side": {"M", "side", "spacing"},
    "rectangles: topology": {"periodic"},
}
"""Errands that change every module which uses one of these names of an object's attributes."""


class Package:
    """The modules of a package below a folder, by name without the package's."""

    def __init__(self, folder: Path) -> None:
        root = folder / "refimpl"
        self.paths = {
            ".".join(p.relative_to(root).with_suffix("").parts).removesuffix(".__init__"): p
            for p in sorted(root.rglob("*.py"))
            if p.parent != root or p.name != "__init__.py"
        }
        self.text = {name: path.read_text(encoding="utf-8") for name, path in self.paths.items()}

    def closure(self, start: Iterable[str]) -> set[str]:
        """All modules that some modules import, directly or not, with themselves."""
        waiting = [name for name in start if name in self.text]
        found = set(waiting)
        while waiting:
            for _, full in imported_names(self.text[waiting.pop()]):
                name = full.removeprefix("refimpl.")
                while name and name not in self.text:
                    name = name.rpartition(".")[0]
                if name and name not in found:
                    found.add(name)
                    waiting.append(name)
        return found

    def users(self, names: set[str]) -> dict[str, int]:
        """How often each module uses one of these attributes."""
        counts = {
            module: sum(isinstance(n, ast.Attribute) and n.attr in names for n in ast.walk(ast.parse(text)))
            for module, text in self.text.items()
        }
        return {module: count for module, count in counts.items() if count}

    def lines(self, names: Iterable[str]) -> int:
        """Lines of some modules."""
        return sum(self.text[name].count("\n") for name in names)


def rows(folder: Path) -> list[tuple[str, int, int, str]]:
    """Errand, number of files, number of lines, and what was counted."""
    package = Package(folder)
    found = []
    for errand, start in READ.items():
        files = package.closure(start)
        found.append((errand, len(files), package.lines(files), "files to read, with all imports"))
    for errand, names in ATTRIBUTES.items():
        users = package.users(names)
        places = f"files with {sum(users.values())} uses of {', '.join(sorted(names))}"
        found.append((errand, len(users), package.lines(users), places))
    return found


def main() -> None:
    """Print one line an errand."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT)
    for errand, files, lines, what in rows(parser.parse_args().folder):
        print(f"{errand:32} {files:4d} files {lines:6d} lines   {what}")


if __name__ == "__main__":
    main()

"""``python -m verification.cli.licences`` writes the table of the pinned packages' licences."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.metadata import Distribution, distributions

from packaging.requirements import Requirement

from verification.framework.provenance import DISTRIBUTION, ROOT

PAGE = ROOT / "docs" / "licences.md"
HEAD = ("Package", "Version", "Licence, as its metadata state it", "Comes with")
_CLASSIFIER = re.compile(r"License :: (?:OSI Approved :: )?(.+)")
_LENGTH = 60  # characters of a licence's text where only that is given


def pinned() -> dict[str, str]:
    """Version of each package of ``constraints.txt`` by its normalised name."""
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pairs = (line.split("==") for line in lines if "==" in line)
    return {normalised(name): version for name, version in pairs}


def normalised(name: str) -> str:
    """Return a package's name as indexes compare it.

    >>> normalised("ast_serialize"), normalised("Jinja2")
    ('ast-serialize', 'jinja2')
    """
    return re.sub("[-_.]+", "-", name).lower()


def licence(package: Distribution) -> str:
    """Return the licence expression, or the classifiers, or the first line of the licence."""

    def stated(field: str) -> list[str]:
        return package.metadata.get_all(field) or []

    classified = [found[1] for one in stated("Classifier") if (found := _CLASSIFIER.match(one))]
    begins = [text.strip("# =\n").split("\n")[0].strip()[:_LENGTH] for text in stated("License")]
    return ", ".join(stated("License-Expression") or classified or begins) or "not stated"


def brought_by(extra: str, among: dict[str, Distribution]) -> set[str]:
    """Names of the packages that come with an extra; "" is the installation without any."""
    found: set[str] = set()
    waiting = [(DISTRIBUTION, extra)]
    seen = set(waiting)
    while waiting:
        name, wanted = waiting.pop()
        for line in among[name].requires or () if name in among else ():
            need = Requirement(line)
            if need.marker is not None and not need.marker.evaluate({"extra": wanted}):
                continue
            found.add(normalised(need.name))
            new = {(normalised(need.name), one) for one in ("", *need.extras)} - seen
            waiting, seen = [*waiting, *new], seen | new
    return found - {DISTRIBUTION}


def rows(before: Mapping[str, Sequence[str]]) -> list[Sequence[str]]:
    """Rows of the table; that of a package that is not installed stays as it was ``before``."""
    among = {normalised(one.metadata["Name"]): one for one in distributions()}
    extras = among[DISTRIBUTION].metadata.get_all("Provides-Extra") or []
    base = brought_by("", among)
    parts = {extra: brought_by(extra, among) - base for extra in extras if extra != "dev"}
    parts["dev"] = brought_by("dev", among) - base.union(*parts.values())
    parts = {"every installation": base, **parts}
    return [
        (name, version, licence(among[name]), ", ".join(p for p in parts if name in parts[p]) or "set-up")
        if name in among
        else before[name]
        for name, version in sorted(pinned().items())
    ]


def table() -> dict[str, Sequence[str]]:
    """Rows of the page's table by name, without its head."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    cells = [line.strip("| ").split(" | ") for line in lines if line.startswith("| ")]
    return {row[0]: row for row in cells[2:]}


def main() -> None:
    """Write the table in the place of that of the page."""
    text = PAGE.read_text(encoding="utf-8").partition("\n| ")[0]
    written = [f"| {' | '.join(row)} |" for row in (HEAD, ("---",) * len(HEAD), *rows(table()))]
    PAGE.write_text("\n".join([text.rstrip(), "", *written, ""]), encoding="utf-8")


if __name__ == "__main__":
    main()

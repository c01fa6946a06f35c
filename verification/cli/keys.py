"""`rough-friction keys`: every key of scene and study files, at the prompt and on the site."""

from __future__ import annotations

import argparse
import re
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING

from verification.cli.options import Options, option
from verification.cli.output import check_outputs, emit
from verification.output.text_table import columns, markdown_row

if TYPE_CHECKING:
    from refimpl.scene.keys import Key

    Tables = Mapping[str, tuple[Key, ...]]

EPILOG = """examples:
  rough-friction keys
  rough-friction keys length
  rough-friction keys gaussian
"""

HEAD = ("key", "unit", "default", "meaning", "also in")

OPTIONS: Options = {
    "word": option(
        "keys with this word in them, or in the name of their table", metavar="WORD", nargs="?", default=""
    ),
}


def run(options: argparse.Namespace) -> int:
    """Print the keys; status 1 where neither a key nor its table has the word."""
    check_outputs((), json=options.json)
    word = options.word.lower()
    found = {
        title: [key for key in keys if word in f"{title} {key.name} {key.meaning}".lower()]
        for title, keys in _tables().items()
    }
    document = {title: [asdict(key) for key in keys] for title, keys in found.items() if keys}
    emit(document, options.json, _table(found))
    return 0 if document else 1


def page(text: str) -> str:
    """Return a page with the table of keys after each comment that names one, ``<!-- NAME -->``.

    What a key allows is printed at the prompt alone: with it the tables are too wide for the site.
    """
    found = {title.removeprefix("surface, "): keys for title, keys in _tables().items()}
    tables = {name: _markdown_table(name, keys) for name, keys in found.items()}
    place = re.compile(rf"<!-- ({'|'.join(tables)}) -->")
    return place.sub(lambda found: tables[found[1]], text)


def _markdown_table(name: str, keys: tuple[Key, ...]) -> str:
    places = also_in(name)
    lines = [markdown_row(title for title in HEAD if places or title != "also in")]
    lines.append("|---" * (len(HEAD) - (not places)) + "|")
    for key in keys:
        where = [places.get(key.name, "")] if places else []
        default = key.default if key.default in ("required", "-") else f"`{key.default}`"
        lines.append(markdown_row([f"`{key.name}`", key.unit, default, key.meaning, *where]))
    return "\n".join(lines)


def also_in(name: str) -> dict[str, str]:
    """Return by key of a table of a scene, whether a study may vary it and whether it has a tolerance.

    >>> also_in("friction")["tau"], also_in("sphere")["radius"], also_in("gaussian")["seed"]
    ('vary, tolerances', 'vary, tolerances', 'vary')
    """
    from refimpl.scene.keys import SAMPLES
    from verification.sweep.keys import uses
    from verification.sweep.study import AXES

    heads = {"scene": "", "friction": "friction.", "material": "lower.material."}
    heads |= dict.fromkeys(SAMPLES, "lower.surface[0].")
    if name not in heads:
        return {}
    head = heads[name]
    found = uses(name if name in SAMPLES else "flat")
    own = {full.removeprefix(head): tables for full, tables in found.items() if full.startswith(head)}
    named = {key: tables for key, tables in own.items() if "." not in key}
    if name in ("scene", "friction"):
        short = ("tau", "beta") if name == "friction" else tuple(set(AXES) - {"tau", "beta"})
        named |= {key: f"vary, {named[key]}" if named.get(key) else "vary" for key in short}
    return named


def _tables() -> Tables:
    from refimpl.scene.keys import scene_keys
    from verification.sweep.keys import study_keys

    return {**scene_keys(), **study_keys()}


def _table(found: Mapping[str, list[Key]]) -> str:
    """Return the keys for a terminal, without the meanings' marks of code."""
    parts = []
    for title, keys in found.items():
        if keys:
            places = also_in(title.removeprefix("surface, "))
            also = {name: f"; also in {where}" for name, where in places.items() if where}
            texts = (f"{key.meaning}; {key.allowed}{also.get(key.name, '')}".replace("`", "") for key in keys)
            rows = [[key.name, key.unit, key.default, text] for key, text in zip(keys, texts, strict=True)]
            parts.append(f"[{title}]\n{columns(rows)}")
    return "\n\n".join(parts) or "no key has this word; what is not modelled: docs/limits.md"

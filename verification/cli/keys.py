"""`rough-friction keys`: every key of scene and study files, at the prompt and as docs/scene-file.md."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.output import Parsers, add_json, check_outputs, columns, emit, output_text, show

if TYPE_CHECKING:
    from refimpl.scene.keys import Key

    Tables = Mapping[str, tuple[Key, ...]]

EPILOG = """examples:
  rough-friction keys
  rough-friction keys length
  rough-friction keys --markdown docs/scene-file.md
"""

HEADINGS = {
    "scene": ("The scene", "At the top of the file."),
    "body": ("Bodies", "`[upper]` and `[lower]` have these tables."),
    "material": ("Materials", "`[upper.material]` and `[lower.material]`."),
    "friction": ("Friction", "`[friction]`."),
    "flat": ("Flat", 'Height zero: `kind = "flat"` has no further key.'),
    "sphere": ("Ball", '`kind = "sphere"`.'),
    "gaussian": (
        "Gaussian roughness",
        '`kind = "gaussian"`, with the autocorrelation of Eq. (9); see [roughness](roughness.md).',
    ),
    "self_affine": (
        "Self-affine roughness",
        '`kind = "self_affine"`, with a power-law PSD; one of `rms` and `rms_gradient` is required. See '
        "[roughness](roughness.md).",
    ),
    "measured": (
        "Measured surface",
        '`kind = "measured"`. Steps are done in this order: outliers and filters on the whole map; replica, '
        "mirror, rotation, turning over; the window about `centre`; the level; missing points. See [measured "
        "surfaces](measured-surfaces.md).",
    ),
    "study": ("The study", "At the top of the file."),
    "vary": (
        "`[vary]`",
        "These, and by full name, in quotation marks, whatever has `vary` in the column *also in* above: "
        '`"lower.surface[0].hurst"`, `"lower.material.E"`. Parts of a surface count from 0; of two '
        'correlation lengths the second one is `"lower.surface[0].correlation_length[1]"`. Values are those '
        "that the scene's own key allows.",
    ),
    "solve": ("`[solve]`", "Options of `refimpl.solve`, for every run."),
}

SCENE_PAGE = """# Scene and study files: every key

Files are TOML, all quantities SI (m, Pa, N, rad). An unknown key, a missing one and a value out of range are
refused in one line that names the key, the value and what is allowed: the column *allowed* below is that
line. This page is written from the code by `rough-friction keys --markdown docs/scene-file.md`, and a test
compares both. `rough-friction keys WORD` prints the keys that have to do with a word.

A scene, complete:

```toml ball.toml
load = 2.0                    # N
side = 1.0e-3                 # m

[upper.material]              # a steel ball
E = 200e9                     # Pa
nu = 0.30
[[upper.surface]]
kind = "sphere"
radius = 0.02                 # m

[lower.material]              # on a rough polymer
E = 3e9
nu = 0.38
[[lower.surface]]             # heights of all parts add up
kind = "gaussian"
rms = 0.3e-6                  # m
correlation_length = 100e-6   # m
seed = 1

[friction]                    # r = tau + beta f, on contact
tau = 0.4e6                   # Pa
beta = 0.1

[tolerances]                  # optional: relative half-widths, 95 %, for the uncertainty budget
"lower.material.E" = 0.05
"friction.tau" = 0.1
```

The column *also in* states where a parameter's full name may stand: in `[tolerances]` of a scene, with a
relative half-width between 0 and 1, and in `[vary]` of a [study](#study-files). Numbers that are zero have no
tolerance.
"""

STUDY_PAGE = """# Study files

A study is a base scene and what varies; `rough-friction sweep STUDY` solves all points ([sweeps](sweeps.md)).

```toml load.toml
scene = "ball.toml"           # or the name of a shipped scene
realisations = 2

[vary]
grid = 64
load = [1.0, 2.0]             # N
"lower.surface[0].rms" = 0.3e-6

[solve]
tolerance = 1e-6
```

```console
$ rough-friction sweep load.toml --workers 1
load.sqlite, ... s
...
  converged           4
...
```
"""
SURFACES_PAGE = """## Surfaces

Every `[[upper.surface]]` and `[[lower.surface]]` has a `kind`: {},
or `sum`, whose `terms` are a list of such tables. Heights are positive upwards on both bodies; those of a
measured surface point out of its material.
"""
HEAD = ("key", "type", "unit", "default", "allowed", "also in", "meaning")


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand."""
    parser = commands.add_parser(
        "keys",
        help="every key of scene and study files: type, unit, default, allowed values, meaning",
        description="Print the keys of scene and study files, or write them as a page.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("word", metavar="WORD", nargs="?", default="", help="keys with this word in them")
    parser.add_argument("--markdown", metavar="FILE", type=output_text, help="write the page of all keys")
    add_json(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the keys; status 1 where none has the word."""
    from verification.framework.files import write_text

    check_outputs((), markdown=options.markdown, json=options.json)
    if options.markdown == Path("-"):
        show(page().rstrip("\n"))
        return 0
    if options.markdown is not None:
        write_text(page(), options.markdown)
        show(f"{options.markdown}: {sum(map(len, _tables().values()))} keys")
        return 0
    found = {title: [key for key in keys if _has(key, options.word)] for title, keys in _tables().items()}
    document = {title: [asdict(key) for key in keys] for title, keys in found.items() if keys}
    emit(document, options.json, _table(found))
    return 0 if document else 1


def page() -> str:
    """Return the page of all keys, as Markdown."""
    from refimpl.scene.keys import scene_keys
    from refimpl.surfaces.from_table import KINDS
    from verification.sweep.keys import study_keys

    parts = [SCENE_PAGE]
    for title, keys in scene_keys().items():
        name = title.removeprefix("surface, ")
        parts += _section("###" if name != title else "##", name, keys)
        if title == "friction":
            parts.append(SURFACES_PAGE.format(", ".join(f"`{kind}`" for kind in KINDS)))
    parts.append(STUDY_PAGE)
    for title, keys in study_keys().items():
        parts += _section("##", title, keys)
    return "\n".join(parts).rstrip("\n") + "\n"


def _section(level: str, name: str, keys: tuple[Key, ...]) -> Iterator[str]:
    heading, text = HEADINGS[name]
    yield f"{level} {heading}\n\n{text}\n"
    if keys:
        places = also_in(name)
        yield _row([title for title in HEAD if places or title != "also in"])
        yield "|---" * (len(HEAD) - (not places)) + "|"
        for key in keys:
            allowed = "" if key.allowed == key.kind else key.allowed
            where = [places.get(key.name, "")] if places else []
            yield _row(
                [f"`{key.name}`", key.kind, key.unit, _code(key.default), allowed, *where, key.meaning]
            )
        yield ""


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def also_in(name: str) -> dict[str, str]:
    """Return, by key of a table of a scene, whether a study may vary it and whether it has a tolerance.

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


def _code(default: str) -> str:
    return default if default in ("required", "-") else f"`{default}`"


def _tables() -> Tables:
    from refimpl.scene.keys import scene_keys
    from verification.sweep.keys import study_keys

    return {**scene_keys(), **study_keys()}


def _has(key: Key, word: str) -> bool:
    return word.lower() in f"{key.name} {key.meaning}".lower()


def _table(found: Mapping[str, list[Key]]) -> str:
    """The keys for a terminal, without the meanings' marks of code."""
    parts = []
    for title, keys in found.items():
        if keys:
            rows = [
                [key.name, key.unit, key.default, f"{key.meaning}; {key.allowed}".replace("`", "")]
                for key in keys
            ]
            parts.append(f"[{title}]\n{columns(rows)}")
    return "\n\n".join(parts) or "no key has this word"

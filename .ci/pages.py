"""Write `out/pages`, from which MkDocs makes the site: committed pages, their sources, options, packages."""

import argparse
import ast
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import griffe
from latex2mathml.converter import convert

import refimpl
from verification.cli import keys, parser

OUT = Path("out/pages")
PACKAGES = ("refimpl", "appendix_a", *(f"verification/{x}" for x in ("framework", "solver_suite", "sweep")))
SOURCE = re.compile(r"(?<=\]\()([\w./-]+\.(?:py|sh|cff|toml))(?=\))")
FIRST = ("solve", "Scene", "Solution", "Body", "Material", "Friction", "read_scene")  # what users call
LAST = "---\nsearch: {boost: 5e-4}\n---\n\n"  # in search results, where titles count 1000 times
NAMED = re.compile(r"^```(\w+) (\S+)$", flags=re.M)
PACKAGE = f"{LAST}::: %s\n    options: {{heading_level: 1}}"
DOCTEST = re.compile(r"^(>>> .*\n?(?:.+\n?)*)", flags=re.M)
FORMULA = re.compile(
    r"^```.*?^```$|`[^`\n]+`|^\$\$\n(?P<block>.+?)\n\$\$$|\$(?P<inline>[^$\s][^$\n]*)\$", flags=re.M | re.S
)
FIELD = re.compile(r"^(\*{0,2}\w+(?:, \w+)*) : (.+)$", flags=re.M)


class Docstrings(griffe.Extension):
    """Docstrings with doctests as code, and fields without types, which signatures have."""

    def on_object(self, *, obj: griffe.Object, **_: object) -> None:
        if obj.docstring and "```" not in obj.docstring.value:
            fenced = DOCTEST.sub(r"```pycon\n\1\n```\n", obj.docstring.value)
            obj.docstring.value = FIELD.sub(r"\1\n    \2", fenced)

    def on_module_members(self, *, mod: griffe.Module, **_: object) -> None:
        self.on_object(obj=mod)


def formula(found: re.Match[str]) -> str:
    """Return a formula as MathML, and code as it is."""
    if found["block"]:
        return f"<div class='formula'>{convert(found['block'], display='block')}</div>"
    return f"<span>{convert(found['inline'])}</span>" if found["inline"] else found[0]


def pages() -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each page."""
    globs = ("README.md", "C*.md", "SECURITY.md", "reports/**/R*.md", "docs/*.md")
    for path in [path for glob in globs for path in Path().glob(glob)]:
        text = (LAST if path.parts[0] == "reports" else "") + path.read_text(encoding="utf-8")
        for link in SOURCE.findall(text):
            name = (path.parent / link).resolve().relative_to(Path().resolve())
            shown = f"```{name.suffix[1:]}\n{name.read_text(encoding='utf-8')}```\n"
            yield f"{name}.md", f"{LAST}# {name}\n\n{shown}"
        if path.stem == "command-line":
            text, after = text.split("\nNext: ")
            text += "\n".join([*options(parser()), f"\nNext: {after}"])
        text = keys.page(text) if path.stem == "scene-file" else text
        text = FORMULA.sub(formula, text)
        yield str(path), NAMED.sub(r'```\1 title="\2"', SOURCE.sub(r"\1.md", text)).replace(".ipynb)", ".md)")
    starts = [path.parent for top in PACKAGES for path in sorted(Path(top).rglob("__init__.py"))]
    packages = {".".join(start.parts): start for start in starts}
    for name, start in packages.items():
        modules = [f"::: {name}.{path.stem}" for path in sorted(start.glob("[!_]*.py"))]
        order = ", ".join(dict.fromkeys([*FIRST, *refimpl.__all__]))
        members = f"\n      group_by_category: false\n      members: [{order}]"
        package = PACKAGE.replace(
            "{heading_level: 1}", f"\n      heading_level: 1{members * (name == 'refimpl')}"
        )
        yield f"api/{name}.md", "\n\n".join([package % name, *modules])
    listed = "".join(f"| [{name}]({name}.md) | {summary(start)} |\n" for name, start in packages.items())
    head = "SI units; fields: shape `(Mx, My)`. Users need `refimpl`.\n\n| package | content |\n|---|---|\n"
    yield "api/README.md", f"# Functions and classes\n\n{head}{listed}"


def summary(package: Path) -> str:
    """Return the first paragraph of a package's docstring as one cell."""
    source = (package / "__init__.py").read_text(encoding="utf-8")
    first = (ast.get_docstring(ast.parse(source)) or "").split("\n\n")[0]
    return " ".join(first.split()).replace("|", r"\|").rstrip(".:")


def options(command: argparse.ArgumentParser) -> Iterator[str]:
    """Yield a heading and a table of options for a command, and for those below it."""
    yield f"\n## {command.prog}\n\n{command.description}\n\n| option | meaning |\n|---|---|"
    form, below = command._get_formatter(), []
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            below += action.choices.values()
        elif action.help != argparse.SUPPRESS:
            meaning = " ".join(form._expand_help(action).split()).replace("|", r"\|")
            yield f"| `{form._format_action_invocation(action)}` | {meaning} |"
    yield from (line for found in below for line in options(found))


def described(notebook: Path) -> str:
    """Return a notebook's page with the alternative texts of its figures, which its cells have."""
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    texts = iter([cell["metadata"]["alt"] for cell in cells if "alt" in cell["metadata"]])
    page = (OUT / notebook.with_suffix(".md")).read_text(encoding="utf-8")
    return re.sub(r"(?<=!\[)png(?=\])", lambda _: next(texts), page)


if __name__ == "__main__":
    for folder in ("docs", "reports/results"):
        shutil.copytree(folder, OUT / folder, dirs_exist_ok=True)
    for name, text in pages():
        (OUT / name).parent.mkdir(parents=True, exist_ok=True)
        (OUT / name).write_text(text, encoding="utf-8")
    for notebook in Path("docs/notebooks").glob("*.ipynb"):
        (OUT / notebook.with_suffix(".md")).write_text(described(notebook), encoding="utf-8")

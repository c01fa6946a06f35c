"""Matplotlib's SVG, made small and fit to stand inside a page: short numbers, own definitions, one name."""

from __future__ import annotations

import re
from html import escape

_HEAD = re.compile(r"^.*?<svg\b[^>]*>", flags=re.S)
_SIZE = re.compile(r'\bviewBox="0 0 ([\d.]+) ([\d.]+)"')
_DECIMALS = re.compile(r"-?\d+\.\d{2,}")
_COORDINATES = re.compile(r'( (?:d|x|y|x1|y1|x2|y2|width|height|points)=")([^"]*)(")')
_TURNED = re.compile(r'( transform=")([^"]*)(")')
_PATH = re.compile(r' d="([^"]*)"')
_COMMAND = re.compile(r" ?([A-Za-z]) ?")
_FONT = re.compile(r"font-family: [^;\"]*;? ?")
_DROPPED = (
    re.compile(r"<metadata>.*?</metadata>", flags=re.S),
    re.compile(r"<!--.*?-->", flags=re.S),
    re.compile(r'<style type="text/css">.*?</style>', flags=re.S),
    re.compile(r"<defs>\s*</defs>"),
)
_INVISIBLE = re.compile(r'<path\b[^>]*\bstyle="fill: none"\s*/>')
_DEFINED = re.compile(r'<(?:clipPath|path|image|linearGradient|pattern)\b[^>]*\bid="([^"]+)"')
_STYLE = re.compile(r'style="([^"]*)"')


def inline(svg: str, name: str, alt: str) -> str:
    """Return an ``<svg>`` with role, alternative text, ids that begin with ``name``; tenths of a point."""
    size = _SIZE.search(svg)
    if size is None:
        raise ValueError("a drawing without a view box")
    width, height = (round(float(v), 1) for v in size.groups())
    body = _HEAD.sub("", svg, count=1)
    for part in _DROPPED:
        body = part.sub("", body)
    body = _COORDINATES.sub(lambda m: m[1] + _DECIMALS.sub(_short, m[2]) + m[3], body)
    body = _TURNED.sub(
        lambda m: m[1] + re.sub(r"-?\d+\.\d{4,}", lambda n: f"{float(n[0]):.3f}", m[2]) + m[3], body
    )
    body = _PATH.sub(lambda m: f' d="{_COMMAND.sub(lambda c: c[1], " ".join(m[1].split()))}"', body)
    body = _named(_FONT.sub("", body), name)
    body = re.sub(r">\s+<", "><", _INVISIBLE.sub("", body).strip()).replace("xlink:href=", "href=")
    body = body.replace(' transform="rotate(-0 ', ' data-0="').replace("<defs></defs>", "")
    body = re.sub(r' data-0="[^"]*"', "", re.sub(r"\n\s*", " ", body))
    return (
        f'<svg class="plot" role="img" aria-label="{escape(alt, quote=True)}" '
        f'viewBox="0 0 {width:g} {height:g}" width="{width:g}" height="{height:g}">{body}'
    )


class StyleSheet:
    """Classes for the style attributes of all figures of a page, which repeat some dozens of them."""

    def __init__(self) -> None:
        self._classes: dict[str, str] = {}

    def shared(self, svg: str) -> str:
        """Return the drawing with classes in place of its style attributes."""
        return _STYLE.sub(lambda m: f'class="{self._name(" ".join(m[1].split()))}"', svg)

    def _name(self, style: str) -> str:
        return self._classes.setdefault(style, f"s{len(self._classes)}")

    @property
    def rules(self) -> str:
        """The rules of the classes, one a line."""
        return "\n".join(f".{name}{{{style}}}" for style, name in self._classes.items())


def _short(match: re.Match[str]) -> str:
    """Round to a tenth of a point, 35 micrometres on paper."""
    short = f"{float(match[0]):.1f}".removesuffix(".0")
    return "0" if short == "-0" else short


def _named(body: str, name: str) -> str:
    ids = {old: f"{name}-{k}" for k, old in enumerate(dict.fromkeys(_DEFINED.findall(body)))}
    used = {old for old in ids if f"#{old})" in body or f'"#{old}"' in body}
    for old in sorted(used, key=len, reverse=True):
        body = body.replace(f'id="{old}"', f'ID="{ids[old]}"')
        body = body.replace(f"#{old})", f"#{ids[old]})").replace(f'"#{old}"', f'"#{ids[old]}"')
    body = re.sub(r' id="[^"]*"', "", body)
    return body.replace(' ID="', ' id="')

"""Random input on the command line: a result, or a refusal in one line with status 2; never a traceback."""

from __future__ import annotations

import contextlib
import io
import tempfile
import warnings
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.identification.data_table import read_rows
from tests.documents import ROOT
from verification.cli import main

TOKENS = (
    "nan", "-inf", "1e400", "0", "-0.0", "-1", "9" * 400, "9" * 5000, "true", "''", "[]", "{}", "[" * 300,
    '"""', "\\", "\x00", "\ufeff", "\u2028", "=", "..", "#", "\n", "1979-05-27T07:32:00Z", "1__0", "x", "",
    'kind = "measured"', 'path = "/dev/zero"', "seed = -1", "seed = 9223372036854775808", "periodic = 1",
    "[upper.material]", "[[upper.surface]]", "side = 1e-300", "load = inf", "nu = 0.5", "radius = 1e-320",
)  # fmt: skip
"""Texts that parsers stumble over."""
OPTIONS = (
    "--grid", "--accuracy", "--quantity", "--method", "--approach", "--oblique", "--plastic", "--tolerance",
    "--size", "--max-grid", "--max-seconds", "--json", "--patches", "--npz", "--unknown",
)  # fmt: skip
SCENES = {
    name: (ROOT / f"refimpl/data/scenes/{name}.toml").read_bytes() for name in ("hertz", "table1-rough")
}
WORDS = (*TOKENS, "8", "friction_coefficient", "dense", "off", "1e-6")
HEIGHTS = np.random.default_rng(5).standard_normal((9, 10))  # nm
IDENTIFIED = b"load,mu,u_mu\n5.0,0.12,0.01\n20.0,0.11,0.01\n70.0,0.1,0.01\n"


@st.composite
def damaged(draw: st.DrawFn, valid: bytes) -> bytes:
    """A valid file with up to three pieces replaced by a token or by random bytes."""
    content = valid
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(content)))
        end = at + draw(st.sampled_from((0, 1, 8, 64, len(content))))
        new = draw(st.sampled_from(TOKENS).map(str.encode) | st.binary(max_size=8))
        content = content[:at] + new + content[end:]
    return content


def check(content: bytes | None, name: str, arguments: list[str]) -> None:
    """Run the command in a folder of its own, where the content is the named file."""
    out, err, by_argparse = io.StringIO(), io.StringIO(), False
    status: object
    with (
        tempfile.TemporaryDirectory() as folder,
        contextlib.chdir(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore", RuntimeWarning)
        if content is not None:
            Path(name).write_bytes(content)
        try:
            status = main(arguments)
        except SystemExit as ended:  # by argparse, which prints its usage first
            status, by_argparse = ended.code, True
    assert status in (0, 1, 2)
    if by_argparse:
        assert err.getvalue().splitlines()[-1].startswith("rough-friction")
    elif status == 2:
        assert err.getvalue().startswith("rough-friction: ")
        assert err.getvalue().count("\n") == 1
        assert out.getvalue() == ""


@settings(max_examples=40)
@given(st.sampled_from(sorted(SCENES)).flatmap(lambda name: damaged(SCENES[name])))
def test_scene_files(content: bytes) -> None:
    check(content, "scene.toml", ["solve", "scene.toml", "--grid", "8"])


@settings(max_examples=40)
@given(st.lists(st.tuples(st.sampled_from(OPTIONS), st.sampled_from(WORDS)), max_size=3))
def test_options(options: list[tuple[str, str]]) -> None:
    check(None, "", ["solve", "hertz", "--grid", "8", *(word for pair in options for word in pair)])


def _surfaces() -> dict[str, bytes]:
    array, table = io.BytesIO(), io.BytesIO()
    np.save(array, HEIGHTS)
    np.savetxt(table, HEIGHTS, fmt="%.6g")
    text = table.getvalue()
    return {".npy": array.getvalue(), ".txt": text, ".csv": text.replace(b" ", b",")}


@settings(max_examples=25)
@given(st.data())
def test_surface_files(data: st.DataObject) -> None:
    surfaces = _surfaces()
    suffix = data.draw(st.sampled_from(sorted(surfaces)))
    arguments = ["inspect", f"map{suffix}", "--unit", "nm", "--pixel-size", "1e-6"]
    check(data.draw(damaged(surfaces[suffix])), f"map{suffix}", arguments)


@settings(max_examples=40)
@given(damaged(IDENTIFIED))
def test_tables_of_friction(content: bytes) -> None:
    """Read alone: a fit of every accepted table would take minutes."""
    with tempfile.TemporaryDirectory() as folder, contextlib.suppress(rf.InputError):
        path = Path(folder) / "friction.csv"
        path.write_bytes(content)
        read_rows(path)

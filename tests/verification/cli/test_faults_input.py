"""What is not to be read: broken, shut and hostile files, by the name of the option that they stand for."""

from __future__ import annotations

import errno
import io
import json
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from reports.generator import render
from tests.reports.sample import case, results
from tests.verification.cli.children import STUDY, Ended, one_line, small
from verification.cli import main
from verification.sweep import engine

WHOLE = json.dumps(results(case("a/1"), case("a/2", "fail")))
CORRUPTED = {
    "cut": WHOLE[: len(WHOLE) // 2], "empty": "", "null": "null", "list": "[]", "number": "1e400",
    "deep": "[" * 100_000, "binary": "\x00\x01\x02", "wrong counts": WHOLE.replace('"pass": 1', '"pass": 7'),
    "no cases": WHOLE.replace('"cases"', '"kases"'), "cases a number": json.dumps(results() | {"cases": 3}),
    "case a text": json.dumps(results() | {"cases": ["x"]}),
    "counts a list": json.dumps(results() | {"counts": []}),
    "provenance null": json.dumps(results() | {"provenance": None}),
    "errata of numbers": json.dumps(results() | {"errata": [1]}),
}  # fmt: skip


@pytest.mark.parametrize("name", CORRUPTED)
def test_corrupted_results_are_refused(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "r.json").write_text(CORRUPTED[name])
    assert main(["report", "--results", str(tmp_path / "r.json"), "--output", str(tmp_path / "out")]) == 2
    one_line(Ended(2, capsys.readouterr().err), "--results", 2)
    assert not (tmp_path / "out").exists()


STUDY_WITHOUT_DATA = json.dumps({"tail": []})


@pytest.mark.parametrize(
    ("option", "bad"),
    [
        ("--results", CORRUPTED["wrong counts"]),
        ("--against", CORRUPTED["wrong counts"]),
        ("--against", "null"),
        ("--committed", CORRUPTED["wrong counts"]),
        ("--committed", "[]"),
        ("--committed", STUDY_WITHOUT_DATA),
    ],
)
def test_the_file_that_is_refused_is_named_by_its_option(
    option: str,
    bad: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("kept").mkdir()
    files = {"--results": "r.json", "--against": "old.json", "--committed": "kept/coverage.json"}
    for name in files.values():
        Path(name).write_text(bad if name == files[option] else WHOLE)
    command = ["report", "--results", "r.json", "--against", "old.json", "--committed", "kept"]
    assert main([*command, "--output", "out"]) == 2
    where = "kept" if bad == STUDY_WITHOUT_DATA else files[option]
    one_line(Ended(2, capsys.readouterr().err), f"{option} = '{where}'", 2)
    assert not Path("out").exists()


def test_a_corrupted_store_is_refused_and_left_as_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = tmp_path / "s.sqlite"
    engine.sweep(small(3), store, workers=0)
    content = bytearray(store.read_bytes())
    content[100:4000] = b"\xa5" * 3900
    store.write_bytes(content)
    (tmp_path / "study.toml").write_text(STUDY)
    assert main(["sweep", str(tmp_path / "study.toml"), "--store", str(store)]) == 2
    one_line(Ended(2, capsys.readouterr().err), "store", 2)
    assert store.read_bytes() == bytes(content)


def other_than(unread: Path, read: Callable[..., str]) -> Callable[..., str]:
    """The same for all paths but one."""

    def reading(path: Path, *args: str, **options: str) -> str:
        assert path != unread
        return read(path, *args, **options)

    return reading


def test_fifty_megabytes_of_toml_are_refused_unread(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "huge.toml"
    with path.open("wb") as file:
        file.write(b"load = 1.0\n")
        file.truncate(50 * 2**20)
    monkeypatch.setattr(Path, "read_text", other_than(path, Path.read_text))
    for command in (["solve"], ["sweep"]):
        assert main([*command, str(path)]) == 2
        one_line(Ended(2, capsys.readouterr().err), "at most", 2)


def opened_but_for(shut: Path) -> Callable[..., object]:
    """Opens all files but one: a mode would not stop root."""
    real = io.open

    def opens(path: object, *args: object, **options: object) -> object:
        if isinstance(path, Path) and path.name == shut.name:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return real(path, *args, **options)  # type: ignore[call-overload]  # passed on as they are

    return opens


@pytest.mark.parametrize(
    ("shut", "command"),
    [
        ("scene.toml", ["solve", "scene.toml", "--grid", "8"]),
        ("scene.toml", ["tradeoff", "scene.toml"]),
        ("scene.toml", ["sweep", "study.toml"]),
        ("study.toml", ["sweep", "study.toml"]),
        ("heights.dat", ["solve", "scene.toml", "--grid", "8"]),
        ("heights.dat", ["sweep", "study.toml"]),
        ("r.json", ["report", "--results", "r.json"]),
        ("old.json", ["report", "--results", "r.json", "--against", "old.json"]),
        ("long.json", ["report", "--results", "r.json", "--committed", "kept"]),
    ],
)
def test_an_input_that_may_not_be_read_is_named_as_one(
    shut: str,
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    np.savetxt("heights.dat", np.random.default_rng(1).standard_normal((8, 8)) * 1e-9)
    measured = '[[lower.surface]]\nkind = "measured"\npath = "heights.dat"\nunit = "m"\npixel_size = 2.1e-4\n'
    Path("scene.toml").write_text(rf.scene_to_toml(rf.read_scene("table1-rough")) + measured)
    Path("study.toml").write_text('scene = "scene.toml"\n[vary]\ngrid = [8]\n')
    Path("kept").mkdir()
    for name in ("r.json", "old.json", "kept/long.json"):
        Path(name).write_text(WHOLE)
    monkeypatch.setattr(io, "open", opened_but_for(Path(shut)))
    assert main(command) == 2
    err = capsys.readouterr().err
    one_line(Ended(2, err), "a file that can be read", 2)
    assert shut in err
    assert "Permission denied" in err


def test_a_folder_is_no_result_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "--results", str(tmp_path)]) == 2
    one_line(Ended(2, capsys.readouterr().err), "a file that can be read (Is a directory)", 2)


# --- hostile texts ---

HOSTILE = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "javascript:alert(1)",
    "' onmouseover='alert(1)",
    "{{ 7 * 7 }}{% raw %}",
    "</title><svg onload=alert(1)>",
    "\u202etxt.exe",
)


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_texts_are_shown_and_not_run(text: str) -> None:
    names = ("title", "claim", "source", "note", "unit", "tolerance_reason")
    hostile = case("a/1", **dict.fromkeys(names, text), data={text: 1.0, "t": text, "m": {text: text}})
    document = results(hostile)
    document["provenance"] |= {"command": text, "commit": text}
    page = render(document)
    for dangerous in ("<script>alert", "<img src=x", "<svg onload", "onmouseover='alert"):
        assert dangerous not in page
    assert "49" not in page.split("<body>")[1].replace("149", "") or "{{ 7 * 7 }}" in page
    assert "default-src 'none'" in page


def test_a_hostile_scene_name_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = "\x1b]0;owned\x07\nroot# rm -rf"
    assert main(["solve", name]) == 2
    err = capsys.readouterr().err
    one_line(Ended(2, err), "scene", 2)
    assert "\x1b" not in err
    (tmp_path / "<script>.toml").write_text(rf.scene_to_toml(rf.read_scene("hertz")))
    assert main(["solve", str(tmp_path / "<script>.toml"), "--grid", "8"]) == 0

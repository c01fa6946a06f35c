"""TOML in and out, the scenes that ship, and keys that are deep, long, or hold what a terminal obeys."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.errors import InputError, printable
from refimpl.model.friction import is_frictionless
from refimpl.scene.scene_file import scene_from_dict, scene_to_dict
from verification.sweep.study_file import read_study


def test_a_name_gives_way_to_a_file_of_that_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = rf.scene_to_toml(rf.read_scene("hertz")).replace("load = 70.0", "load = 1.0")
    (tmp_path / "hertz").write_text(text)
    monkeypatch.chdir(tmp_path)
    assert rf.read_scene("hertz").load == 1.0


def test_a_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(rf.scene_to_toml(rf.read_scene("hertz")), encoding="utf-8-sig")
    assert scene_to_dict(rf.read_scene(path)) == scene_to_dict(rf.read_scene("hertz"))


def test_optional_keys_have_their_defaults() -> None:
    body = {"material": {"E": 1e9, "nu": 0.3}}
    scene = scene_from_dict({"load": 1.0, "side": 1.0, "upper": body, "lower": body}, Path())
    assert is_frictionless(scene.friction)
    assert (scene.sliding_direction, scene.sliding_offset, scene.periodic) == (0.0, 0.0, False)
    assert isinstance(scene.lower.surface, rf.Flat)


def test_one_surface_need_not_be_a_list() -> None:
    body = {"material": {"E": 1e9, "nu": 0.3}, "surface": {"kind": "sphere", "radius": 2.0}}
    scene = scene_from_dict({"load": 1.0, "side": 1.0, "upper": body, "lower": body}, Path())
    assert scene.upper.surface == rf.Sphere(2.0)


@pytest.mark.parametrize("key", ["E", "nu"])
def test_a_number_that_a_material_lacks_is_named_in_full(key: str) -> None:
    table = scene_to_dict(rf.read_scene("hertz"))
    del table["lower"]["material"][key]
    with pytest.raises(rf.InputError) as refused:
        scene_from_dict(table, Path())
    assert refused.value.field == f"lower.material.{key}"


SCENE = rf.scene_to_toml(rf.read_scene("hertz"))
READERS = [rf.read_scene, read_study]


@pytest.mark.parametrize("read", READERS)
@pytest.mark.parametrize(
    ("parts", "form", "part"),
    [
        (40, "{} = 1\n", "a"),
        (1500, "[{}]\n", '"a.b"'),
        (20_000, "[[{}]]\n", "'a'"),
        (20_000, "x = {{ {} = 1 }}\n", "a"),
    ],
)
def test_dotted_keys_of_many_parts_are_refused_at_once(
    read: object, parts: int, form: str, part: str, tmp_path: Path
) -> None:
    (tmp_path / "s.toml").write_text(form.format(" . ".join([part] * parts)))
    begun = time.process_time()
    with pytest.raises(InputError, match="dotted keys"):
        read(tmp_path / "s.toml")  # type: ignore[operator]  # one of READERS
    assert time.process_time() - begun < 1.0


def test_paths_with_many_dots_are_no_keys(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text("# " + "../" * 100 + "\n" + SCENE)
    rf.read_scene(tmp_path / "s.toml")


@pytest.mark.parametrize(
    ("line", "after", "says"),
    [
        ("tau = 15e6", "", r"scene.tau = .*one of \[friction\]"),
        ("hardness = 1e9", "[lower]", r"lower.hardness = .*one of a body's \[material\]"),
        ("sliding_direction = 0.5", "[friction]", r"sliding_direction = .*one of the top of a scene"),
        ("rms = 1e-6", "[lower.material]", r"material.rms = .*one of a \[\[surface\]\] of kind gaussian"),
    ],
)  # fmt: skip
def test_a_key_in_the_wrong_table_names_the_right_one(
    line: str, after: str, says: str, tmp_path: Path
) -> None:
    text = "load = 1.0\nside = 1e-3\n"
    for table in ("[lower]", "[lower.material]", "[upper]", "[upper.material]", "[friction]"):
        text += f"{table}\n{line if table == after else ''}\n"
        text += "E = 1e9\nnu = 0.3\n" if "material" in table else ""
    (tmp_path / "s.toml").write_text(text if after else f"{line}\n{text}")
    with pytest.raises(InputError, match=says):
        rf.read_scene(tmp_path / "s.toml")


@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(key=st.text(st.characters(codec="utf-8", exclude_characters='"\\'), min_size=1, max_size=20))
def test_no_key_reaches_a_terminal_unescaped(key: str, tmp_path: Path) -> None:
    escaped = "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in key)
    (tmp_path / "s.toml").write_text(f'"x{escaped}" = 1\n{SCENE}', encoding="utf-8")
    with pytest.raises(InputError) as refused:
        rf.read_scene(tmp_path / "s.toml")
    assert str(refused.value).isprintable()


def test_tables_in_tables_are_shown_without_recursion() -> None:
    value: dict[str, object] = {}
    for _ in range(100_000):
        value = {"a": value}
    assert "tables in tables" in str(InputError("scene.a", value, "no such key"))


@given(st.text())
def test_printable_texts_stay_and_all_others_become_so(text: str) -> None:
    assert printable(text).isprintable()
    assert printable(text) == text or not text.isprintable()

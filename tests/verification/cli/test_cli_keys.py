"""The reference of all keys: it states what files may hold, and the page of scene files names each."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from refimpl import InputError
from refimpl.scene import scene_file
from refimpl.scene.keys import REQUIRED, SAMPLES, sample_scene, scene_keys
from refimpl.scene.scene_file import _OPTIONAL_KEYS, scene_from_dict
from refimpl.surfaces import surface_from_dict
from refimpl.surfaces.from_table import KINDS
from tests.documents import ROOT
from verification.cli import main
from verification.cli.keys import page
from verification.sweep.keys import study_keys
from verification.sweep.study_file import KEYS, SOLVE_KEYS, study_from_dict

TABLES = scene_keys()
PAGE = ROOT / "docs" / "scene-file.md"


def test_the_page_has_a_place_for_every_table_and_the_site_fills_it() -> None:
    committed = PAGE.read_text(encoding="utf-8")
    made = page(committed)
    added = made.count("\n|---") - committed.count("\n|---")
    assert added == sum(map(bool, [*TABLES.values(), *study_keys().values()]))
    assert "<!--" not in made
    assert all(f"| `{key.name}` |" in made for table in TABLES.values() for key in table)
    names = [*KINDS, *(key.name for table in TABLES.values() for key in table)]
    assert [name for name in names if not re.search(rf"\b{name}\b", committed)] == []


def test_all_keys_that_a_file_may_have_are_there() -> None:
    assert {key.name for key in TABLES["scene"]} == set(scene_file.SCENE)
    assert {key.name for key in study_keys()["study"]} == set(KEYS)
    assert {key.name for key in study_keys()["solve"]} == set(SOLVE_KEYS)
    with pytest.raises(InputError) as refused:  # the reader's own list of the keys of that kind
        surface_from_dict({"kind": "self_affine", "none": 1})
    listed = refused.value.allowed.partition(": ")[2].split(", ")
    assert [key.name for key in TABLES["surface, self_affine"]] == listed


def test_a_table_of_no_surface_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(scene_file.SURFACES, "bogus", {})
    with pytest.raises(LookupError, match="bogus"):
        scene_keys()


def test_required_keys_are_those_that_cannot_be_missing() -> None:
    for kind, samples in SAMPLES.items():
        for key in TABLES[f"surface, {kind}"]:
            table = {"kind": kind, **samples[0]}
            table.pop(key.name, None)
            if key.default == REQUIRED:
                with pytest.raises(InputError):
                    surface_from_dict(table)
    for name in ("load", "upper", "lower"):
        scene = sample_scene()
        del scene[name]
        with pytest.raises(InputError):
            scene_from_dict(scene, Path())


def test_stated_defaults_are_what_is_used() -> None:
    """A file with every default written out is the file without them."""
    for kind, samples in SAMPLES.items():
        stated = {
            key.name: json.loads(key.default)
            for key in TABLES[f"surface, {kind}"]
            if key.default not in (REQUIRED, "-") and key.name not in samples[0]
        }
        bare = {"kind": kind, **samples[0]}
        assert surface_from_dict(stated | bare) == surface_from_dict(bare)
    keys = {key.name: key.default for key in TABLES["scene"] if key.name in _OPTIONAL_KEYS}
    stated = {name: json.loads(default) for name, default in keys.items() if default != "-"}
    assert stated == {"sliding_direction": 0.0, "sliding_offset": 0.0, "periodic": False}
    bare = study_from_dict({"scene": "table1-rough", "vary": {"grid": 8}})
    whole = {"realisations": 1, "vary": {"grid": 8}, "solve": {}}
    assert study_from_dict({"scene": "table1-rough", **whole}) == bare


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["keys", "hurst"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("[surface, self_affine]\n  hurst")
    assert "0 < H <= 1; also in vary, tolerances" in " ".join(printed.split())
    assert main(["keys", "measured"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.count("also in") == 3  # path, rotate_deg, height_scale
    assert main(["keys", "gaussian", "--json", "-"]) == 0  # the name of a table
    document = json.loads(capsys.readouterr().out)
    assert [key["name"] for key in document["surface, gaussian"]] == [
        key.name for key in TABLES["surface, gaussian"]
    ]
    assert main(["keys", "no-such-word"]) == 1
    assert capsys.readouterr().out == "no key has this word; what is not modelled: docs/limits.md\n"
    assert main(["keys", "tau", "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [key["unit"] for key in document["friction"] if key["name"] == "tau"] == ["Pa"]

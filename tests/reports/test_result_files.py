"""The compact form of result files loses nothing, is small, and is refused when it is damaged."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reports.result_files import LAYOUT, LayoutError, compact, main, read_result, read_results, write_result
from tests.documents import ROOT

RESULTS = ROOT / "reports" / "results"
RECORDS = [
    {"name": f"{k % 3} of a text that is long enough to be shared", "x": k / 7, "y": 0.0} for k in range(9)
]
SCALARS = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
)
KEYS = st.text(max_size=3).filter(lambda key: not key.startswith("$"))
VALUES = st.recursive(
    SCALARS | st.builds(lambda value, n: [value] * n, SCALARS, st.integers(0, 60)),
    lambda inner: (
        st.lists(inner, max_size=5)
        | st.dictionaries(KEYS, inner, max_size=4)
        | st.builds(lambda value, n: [value] * n, inner, st.integers(0, 4))
        | st.lists(st.fixed_dictionaries({"a": inner, "b": inner}), max_size=4)
        | st.dictionaries(KEYS, st.fixed_dictionaries({"a": inner, "b": inner}), max_size=4)
    ),
    max_leaves=30,
)


def text(document: object) -> str:
    """Every number with all its digits, and the order of keys."""
    return json.dumps(document)


@given(document=st.dictionaries(KEYS, VALUES, max_size=5), most=st.integers(1, 2000))
def test_documents_come_back_to_the_last_bit(
    document: dict[str, Any], most: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    compact(document, most)  # raises where its files do not lead back
    path = tmp_path_factory.mktemp("results") / "a.json"
    write_result(document, path)
    assert text(read_result(path)) == text(document)


def test_zeros_ones_and_booleans_are_not_mistaken() -> None:
    mixed = 30 * [0.0] + 30 * [-0.0] + 30 * [0] + 30 * [False] + 30 * [1] + 30 * [True] + 30 * [1.0]
    assert len(compact({"x": mixed})[0]) < 350


def test_records_are_columns_and_texts_are_stored_once() -> None:
    (made,) = compact({"rows": RECORDS})
    assert made.count('"name"') == 1
    assert made.count("1 of a text") == 1
    assert '{"$times":[9,0.0]}' in made
    assert max(map(len, made.splitlines())) <= 110


def test_records_by_name_are_columns_and_names(tmp_path: Path) -> None:
    """And files of before, which have no names, are read as they were."""
    document = {"mu": {"mean": 0.5, "seen": 3}, "A": {"mean": 0.25, "seen": 3}}
    (made,) = compact(document)
    table = '{"$names":["mu","A"],"$table":{"mean":[0.5,0.25],"seen":[3,3]}}'
    assert f'"document":{table},' in made
    before = made.replace("version 2", "version 1").replace(table, json.dumps(document))
    for number, form in enumerate((made, before)):
        (tmp_path / f"{number}.json").write_text(form)
        assert text(read_result(tmp_path / f"{number}.json")) == text(document)


def test_long_lists_continue_in_other_files(tmp_path: Path) -> None:
    path, document = (
        tmp_path / "a.json",
        {"head": 1, "rows": [{"x": list(range(k, k + 90))} for k in range(9)]},
    )
    write_result(document, path, most_bytes=1000)
    names = sorted(file.name for file in tmp_path.iterdir())
    assert names[:2] == ["a.2.json", "a.3.json"]
    assert max(file.stat().st_size for file in tmp_path.iterdir()) <= 1000
    assert read_results(tmp_path) == {"a": document}
    first = (tmp_path / "a.2.json").read_text()
    document["rows"].append({"x": [0]})
    write_result(document, path, most_bytes=1000)
    assert (tmp_path / "a.2.json").read_text() == first  # only the end of a record that grows has changed
    (tmp_path / "a.2.json").write_text(first.replace("1", "2", 1))
    with pytest.raises(LayoutError, match=r"a\.2\.json does not belong to a\.json"):
        read_result(path)
    (tmp_path / "a.2.json").unlink()
    with pytest.raises(LayoutError, match=r"continues in a\.2\.json, which is missing"):
        read_result(path)
    write_result({"rows": []}, path)
    assert not (tmp_path / "a.2.json").exists()


def test_plain_files_are_read_and_rewritten(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps({"rows": RECORDS}, indent=1))
    before = path.stat().st_size
    assert read_result(path) == {"rows": RECORDS}
    main([str(path)])
    assert path.stat().st_size < before
    assert read_result(path) == {"rows": RECORDS}


@pytest.mark.parametrize("document", [{"x": float("nan")}, {"x": float("inf")}, {"$times": [3, 0]}])
def test_what_it_cannot_hold_is_refused(document: dict[str, object], tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"JSON|begins with"):
        write_result(document, tmp_path / "a.json")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "damaged",
    [
        {"document": {"$same": "a"}, "shared": {}},
        {"document": {"$same": "a"}, "shared": {"a": [{"$same": "a"}]}},
        {"document": {"$same": []}, "shared": {}},
        {"document": {"$table": {"x": [1], "y": [1, 2]}}, "shared": {}},
        {"document": {"$table": 3}, "shared": {}},
        {"document": {"$names": ["a"], "$table": {"x": [1, 2]}}, "shared": {}},
        {"document": {"$names": [["a"], ["b"]], "$table": {"x": [1, 2]}}, "shared": {}},
        {"document": [{"$times": [10**12, 0]}], "shared": {}},
        {"document": [{"$times": [0, 0]}], "shared": {}},
        {"document": [{"$times": ["x", 0]}], "shared": {}},
        {"document": [{"$times": 7}], "shared": {}},
        {"document": {}, "shared": {}},
        {"document": {}, "shared": {}, "continued": {"list": "rows", "digests": 3}},
        {"shared": {}},
        {},
    ],
)
def test_damaged_files_are_refused(damaged: dict[str, object], tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(json.dumps({"layout": LAYOUT, **damaged}))
    with pytest.raises(LayoutError):
        read_result(tmp_path / "a.json")


def test_committed_results_are_as_the_writer_leaves_them() -> None:
    """All but the study of `appendix_a`, which is no part of what imports the writer, one point a line."""
    for path in RESULTS.glob("*.json"):
        compact_form = json.loads(path.read_text(encoding="utf-8")).get("layout") == LAYOUT
        assert compact_form == (path.stem != "appendix_a_3d"), path.name

"""Result files keep every digit, plain or compressed, and are refused when they are damaged."""

from __future__ import annotations

import gzip
import json
import zlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from verification.output import result_files
from verification.output.result_files import FOLDER, committed, main, read_result, read_results, write_result

DOCUMENT = {"rows": [{"x": k / 7, "name": f"Größe {k}"} for k in range(90)], "none": None}
SCALARS = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
)
VALUES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(), inner, max_size=4)
)


@given(document=VALUES)
@pytest.mark.parametrize("name", ["a.json", "a.json.gz"])
def test_documents_come_back_to_the_last_bit(
    name: str, document: Any, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """As text: -0.0 and 0, 1 and True, and the order of keys differ."""
    path = tmp_path_factory.mktemp("results") / name
    write_result(document, path)
    assert json.dumps(read_result(path)) == json.dumps(document)


def test_the_suffix_decides_and_the_bytes_are_the_same_again(tmp_path: Path) -> None:
    plain, packed, again = (tmp_path / name for name in ("a.json", "b.json.gz", "c.json.gz"))
    for path in (plain, packed, again):
        write_result(DOCUMENT, path)
    assert json.loads(plain.read_text(encoding="utf-8")) == DOCUMENT
    assert gzip.decompress(packed.read_bytes()) == plain.read_bytes()
    assert packed.read_bytes() == again.read_bytes()
    assert packed.stat().st_size < plain.stat().st_size / 2
    assert read_results(tmp_path) == dict.fromkeys("abc", DOCUMENT)


def test_a_plain_file_is_compressed_in_its_place(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(json.dumps(DOCUMENT, indent=1))
    main([str(tmp_path / "a.json")])
    main([str(tmp_path / "a.json.gz")])
    assert [path.name for path in tmp_path.iterdir()] == ["a.json.gz"]
    assert read_results(tmp_path) == {"a": DOCUMENT}


def test_a_name_with_both_forms_is_refused(tmp_path: Path) -> None:
    for name in ("a.json", "a.json.gz", "b.json"):
        write_result({}, tmp_path / name)
    with pytest.raises(ValueError, match=r"a\.json and a\.json\.gz"):
        read_results(tmp_path)


def test_what_json_does_not_hold_is_neither_written_nor_read(tmp_path: Path) -> None:
    number = float("inf")
    with pytest.raises(ValueError, match="JSON"):
        write_result({"x": number}, tmp_path / "a.json")
    assert not list(tmp_path.iterdir())
    (tmp_path / "a.json").write_text(json.dumps({"x": number}))
    with pytest.raises(ValueError, match="is not JSON"):
        read_result(tmp_path / "a.json")


PACKED = gzip.compress(json.dumps(DOCUMENT).encode(), mtime=0)


@pytest.mark.parametrize(
    "content",
    [
        PACKED[:-1],  # the checksum is cut
        PACKED + b"x",
        PACKED[:40] + b"\xff" + PACKED[41:],
        gzip.compress(b'{"x": 1', mtime=0),
        zlib.compress(b"{}"),
    ],
)
def test_damaged_files_are_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.json.gz").write_bytes(content)
    with pytest.raises(ValueError):
        read_result(tmp_path / "a.json.gz")


def test_a_small_file_does_not_fill_the_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(result_files, "MOST_BYTES", 1000)
    for zeros, accepted in ((900, True), (1_000_000, False)):
        (tmp_path / "a.json.gz").write_bytes(gzip.compress(b"[" + b" " * zeros + b"]"))
        if accepted:
            assert read_result(tmp_path / "a.json.gz") == []
        else:
            with pytest.raises(ValueError, match="more than 1000 bytes"):
                read_result(tmp_path / "a.json.gz")


def test_committed_results_are_as_the_writer_leaves_them(tmp_path: Path) -> None:
    for path in FOLDER.glob("*.json.gz"):
        found = gzip.decompress(path.read_bytes())
        assert found == result_files.encoded(committed(path.name.partition(".")[0]), tmp_path / "a.json")

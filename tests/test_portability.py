"""What runs on Linux, Windows and macOS: the command line without what only POSIX has, texts in UTF-8."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator

import pytest

from refimpl import operating_system
from tests.documents import ROOT
from tests.verification.cli.commands import refused

PACKAGES = ("refimpl", "appendix_a", "verification", "reports", "examples")


def unstated_encodings(source: str) -> Iterator[int]:
    """Lines that read or write a text without a word on its encoding."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        words = {word.arg: word.value for word in node.keywords}
        place = 0 if isinstance(node.func, ast.Attribute) and name == "open" else 1
        mode = words.get("mode", [*node.args, *[ast.Constant("r")] * 2][place])
        opened = name in ("open", "fdopen") and isinstance(mode, ast.Constant) and "b" not in str(mode.value)
        least = {"read_text": 0, "write_text": 1}.get(name)  # arguments before the encoding
        moved = isinstance(node.func, ast.Attribute) and len(node.args) == least
        if (opened or moved or "text" in words or "universal_newlines" in words) and "encoding" not in words:
            yield node.lineno


def test_every_text_states_its_encoding() -> None:
    files = [path for package in PACKAGES for path in (ROOT / package).rglob("*.py")]
    lines = [(path, line) for path in files for line in unstated_encodings(path.read_text(encoding="utf-8"))]
    assert [f"{path.relative_to(ROOT)}:{line}" for path, line in lines] == []
    for breach in (
        "p.open()",
        "open(p, 'w')",
        "p.read_text()",
        "subprocess.run(w, text=True)",
        "os.fdopen(2, 'w')",
    ):
        assert list(unstated_encodings(breach)) == [1], breach


def test_names_that_windows_takes_for_devices_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(operating_system.is_device, "__kwdefaults__", {"windows": True})
    refused("solve hertz --grid 8 --json nul.json", "device")


def test_numbers_of_the_machine() -> None:
    assert 1 <= operating_system.cores() <= 4096
    assert 2e7 < operating_system.peak_memory() < 1e11
    assert operating_system.processor_name() or sys.platform != "linux"

"""Which commits a checkout knows."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from verification.output import provenance


def test_provenance_that_cannot_be_had_is_null(monkeypatch: pytest.MonkeyPatch) -> None:
    def raises(*_: object) -> None:
        raise TypeError("odd metadata")

    for owner, name in ((provenance, "version"), (provenance.platform, "platform")):
        monkeypatch.setattr(owner, name, raises)
    assert provenance.versions()["numpy"] is None
    assert provenance.machine()["platform"] is None


def git(*arguments: str) -> str:
    who = ("-c", "user.name=n", "-c", "user.email=e")
    done = subprocess.run(["git", *who, *arguments], check=True, capture_output=True, text=True)
    return done.stdout.strip()


def test_a_commit_is_unknown_only_to_a_whole_history(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole, shallow, none = (tmp_path / name for name in ("whole", "shallow", "none"))
    git("init", "-q", str(whole))
    for text in ("first", "second"):
        (whole / "pyproject.toml").write_text(text)
        git("-C", str(whole), "add", ".")
        git("-C", str(whole), "commit", "-qm", text)
    git("clone", "-q", "--depth", "1", whole.as_uri(), str(shallow))
    none.mkdir()
    head, other = git("-C", str(whole), "rev-parse", "HEAD"), "0" * 40
    for root, known in ((whole, False), (shallow, True), (none, True)):
        monkeypatch.setattr(provenance, "ROOT", root)
        assert provenance.is_known(head)
        assert [provenance.is_known(name) for name in (other, "0000", "--help")] == [known] * 3

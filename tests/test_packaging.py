"""What ships: every file of the packages is declared as package data, and the types are announced.

That a wheel installs and runs elsewhere is checked by `.ci/package`, which takes a minute and an index.
"""

from __future__ import annotations

import os
import tomllib

import pytest

from tests.documents import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
DATA: dict[str, list[str]] = PROJECT["tool"]["setuptools"]["package-data"]
PACKAGES = ("refimpl", "appendix_a", "verification", "reports")


@pytest.mark.parametrize("package", PACKAGES)
def test_every_data_file_ships(package: str) -> None:
    folder = ROOT / package
    declared = {path for pattern in DATA[package] for path in folder.glob(pattern) if path.is_file()}
    there = {
        path
        for path in folder.rglob("*")
        if path.is_file() and path.suffix not in (".py", ".pyc") and not path.name.startswith(".")
    }
    assert there - declared == set()
    assert folder / "py.typed" in declared
    assert all(list(folder.glob(pattern)) for pattern in DATA[package])


@pytest.mark.parametrize("package", PACKAGES)
def test_every_folder_of_modules_is_a_package(package: str) -> None:
    folders = {path.parent for path in (ROOT / package).rglob("*.py")}
    assert [str(folder) for folder in folders if not (folder / "__init__.py").is_file()] == []


def test_every_dependency_states_a_least_version() -> None:
    extras = PROJECT["project"]["optional-dependencies"]
    lists = [PROJECT["project"]["dependencies"], *extras.values()]
    assert all(">=" in line or line.startswith("rough-friction[") for names in lists for line in names)


def test_the_wheels_check_can_be_run() -> None:
    assert os.access(ROOT / ".ci/package", os.X_OK)

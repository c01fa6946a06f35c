"""What ships: every file of the packages is declared as package data, and the types are announced.

That a wheel installs and runs elsewhere is checked by `.ci/package`, which takes a minute and an index.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import distributions
from pathlib import Path

import pytest

from tests.layers import PACKAGES, ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
DATA: dict[str, list[str]] = PROJECT["tool"]["setuptools"]["package-data"]


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


EXTRAS_TESTED_ELSEWHERE = {
    "instrument", "rigorous", "fast", "docs", "mutation", "tamaas", "contactmechanics", "aspher", "dev",
}  # fmt: skip
"""The first three are set up by make beside dev; tests run neither the site nor the studies of the others."""


def test_what_ci_installs_has_the_extras_that_tests_use() -> None:
    extras = PROJECT["project"]["optional-dependencies"]
    (own,) = (line for line in extras["dev"] if line.startswith("rough-friction["))
    assert set(own.partition("[")[2].rstrip("]").split(",")) == set(extras) - EXTRAS_TESTED_ELSEWHERE


COPYLEFT = {"ducc0", "igor2", "python-flint", "muGrid", "tamaas"}
"""Packages under a copyleft licence; `docs/licences.md` names the extras that bring them."""


def test_packages_under_a_copyleft_licence_are_on_the_page() -> None:
    page = (ROOT / "docs/licences.md").read_text(encoding="utf-8")
    assert all(name in page for name in COPYLEFT)
    pinned = {line.partition("==")[0].lower() for line in (ROOT / "constraints.txt").read_text().splitlines()}
    for package in distributions():
        stated = package.metadata
        licence = stated.get("License-Expression") or stated.get("License", "")[:60]  # or a text
        words = [licence, *(stated.get_all("Classifier") or ())]
        if package.name.lower() in pinned and any(re.search("GPL|General Public", word) for word in words):
            assert package.name in COPYLEFT


def test_the_tools_are_those_of_the_extra() -> None:
    """Once as a group, once for versions of pip that know none."""
    extra = PROJECT["project"]["optional-dependencies"]["dev"]
    assert PROJECT["dependency-groups"]["dev"] == [each for each in extra if not each.startswith("rough-")]


def run(*arguments: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Python in a folder, whose modules come before the checkout's."""
    paths = {"PYTHONPATH": os.pathsep.join((str(folder), str(ROOT)))}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=os.environ | paths | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_model_needs_numpy_scipy_and_three_small_packages() -> None:
    """Of what is installed with it, the rest is for verification, pictures, files of meshes and reports."""
    needed = {"numpy", "scipy", "psutil", "threadpoolctl", "tomli-w"}
    others = {re.split("[>=]", line)[0] for line in PROJECT["project"]["dependencies"]} - needed
    names = {"scikit-fem": "skfem"}
    blocked = "".join(f"sys.modules[{names.get(name, name)!r}] = None\n" for name in sorted(others))
    solve = "import refimpl as rf; assert rf.solve(rf.read_scene('table1-rough'), grid=24).converged"
    done = run("-c", f"import sys\n{blocked}{solve}", folder=ROOT)
    assert done.returncode == 0, done.stderr


OPTIONAL = (
    "xarray", "h5netcdf", "h5py", "pandas", "pyarrow", "dask", "distributed", "ducc0", "flint",
    "SurfaceTopography", "cosmic_ray", "tamaas", "ContactMechanics", "aspher",
)  # fmt: skip


def test_without_any_extra_it_solves_plots_and_writes_csv(tmp_path: Path) -> None:
    blocked = "".join(f"sys.modules[{name!r}] = None\n" for name in OPTIONAL)
    (tmp_path / "sitecustomize.py").write_text(
        f"import sys\n{blocked}"
    )  # workers of a sweep start with it too
    (tmp_path / "study.toml").write_text('scene = "hertz"\n[vary]\ngrid = 8\nload = [1.0, 2.0]\n')
    commands = (
        "solve hertz --grid 8 --plot s.png --patches s.csv --npz s.npz --vtk s.vtu --json s.json",
        "sweep study.toml --workers 1 --csv t.csv --plot t.pdf",
    )
    code = "from verification.start import run; raise SystemExit(any(run(c.split()) for c in sys.argv[1:]))"
    done = run("-c", f"import sys; {code}", *commands, folder=tmp_path, MPLBACKEND="none such")
    assert done.returncode == 0, done.stderr
    written = {path.name for path in tmp_path.iterdir() if path.stat().st_size > 100}
    assert written >= {"s.png", "s.csv", "s.npz", "s.vtu", "s.json", "t.csv", "t.pdf"}


def test_a_module_that_hides_the_package_is_named_in_one_line(tmp_path: Path) -> None:
    """By the console script's entry, and by `python -m`, which looks in the working directory first."""
    name = "verification.py"
    (tmp_path / name).write_text("raise RuntimeError('imported')\n")
    entry = "import rough_friction; raise SystemExit(rough_friction.run())"
    for how in (["-c", entry], ["-m", "rough_friction"]):
        done = run(*how, "--help", folder=tmp_path)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
        assert f"{tmp_path / name} hides" in done.stderr

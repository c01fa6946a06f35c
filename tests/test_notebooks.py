"""The notebooks run, print the numbers stated here in their last cell, and are committed without outputs."""

from __future__ import annotations

import ast
import importlib
import json
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tests.conftest import PACKAGES
from tests.documents import ROOT, agree
from tests.test_examples import legible

FOLDER = ROOT / "docs" / "notebooks"
STATED = {
    "area_and_load": """
        11 of 11 converged
        A/A0 at 0.02: 0.0463, Greenwood and Williamson 0.0412, Persson 0.0319
        kappa 2.21 to 2.36, Nayak's parameter 1.8 to 11.6
    """,
    "power_to_amontons": """
        24 of 24 converged
        powers -0.33 -0.19 -0.01 +0.03
        tau 15.0 MPa, beta 0.081
    """,
    "wave_to_full_contact": """
        16 of 16 converged
        full contact: pressures differ from the exact ones by less than 1e-6 p*: True
        half: A/A0 = 0.500 in x, 0.706 in x and y
    """,
    "ball_on_rough_flat": """
        mu = 0.1057 on 64 x 64, converged
        fine mu = 0.1064, within the bar: True
        A = 0.1250 mm^2 in 27 patches
    """,
    "checking_a_solver": """
        right: 3 of 3 pass
        too_stiff: 0 of 3 pass
        transposed: 1 of 3 pass
        both solvers agree: True, load 0.2000 N
    """,
    "friction_against_direction": """
        24 of 24 converged
        mu from 0.1165 to 0.1214
        Q/P from -0.0025 to +0.0025
        across over along, both ways: +0.00%
    """,
    "two_maps_along_a_track": """
        21 of 21 converged
        mu from 0.114 to 0.133, mean 0.1236
        Sq = 0.249 um, median bar 2.4%
    """,
    "yield_study": """
        psi from 0.22 to 4.31, plastic share from 0.00 to 0.90
        mu 0.1551 at 0.2 GPa, Eq. (11) 0.1550
        mu 0.1079 at 0.8 GPa, elastic 0.1069, change +0.9%
    """,
}


def cells(name: str) -> list[dict[str, Any]]:
    notebook = json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))
    found: list[dict[str, Any]] = notebook["cells"]
    return found


def test_no_notebook_is_left_out() -> None:
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == set(STATED)
    page = (ROOT / "docs/notebooks.md").read_text(encoding="utf-8")
    assert [name for name in STATED if f"(notebooks/{name}.ipynb)" not in page] == []


@pytest.mark.parametrize("name", STATED)
def test_it_is_committed_without_outputs(name: str) -> None:
    code = [cell for cell in cells(name) if cell["cell_type"] == "code"]
    assert code
    assert [cell["id"] for cell in code if cell["outputs"] or cell["execution_count"] is not None] == []
    assert cells(name)[0]["source"][0].startswith("# ")


@pytest.mark.parametrize("name", STATED)
def test_figures_are_legible_on_a_phone_and_have_a_text(name: str) -> None:
    """As tests/test_examples.py has it of pictures; the alternative text is in the cell's metadata."""
    for cell in cells(name):
        source = "".join(cell["source"])
        if cell["cell_type"] == "code" and "plt.subplots(" in source:
            inches = float(re.findall(r"figsize=\(([\d.]+)", source)[0])
            assert legible(source, inches)
            assert len(cell["metadata"]["alt"].split()) > 5


@pytest.mark.parametrize("name", STATED)
def test_what_it_takes_from_our_modules_is_there(name: str) -> None:
    """Most notebooks run at night alone: a function that goes must be noticed by day."""
    code = ("".join(cell["source"]) for cell in cells(name) if cell["cell_type"] == "code")
    tree = list(ast.walk(ast.parse("\n".join(code))))
    modules: dict[str, ModuleType] = {}
    for node in tree:
        if isinstance(node, ast.Import):
            ours = [each for each in node.names if each.name.partition(".")[0] in PACKAGES]
            modules |= {each.asname or each.name: importlib.import_module(each.name) for each in ours}
        elif isinstance(node, ast.ImportFrom) and str(node.module).partition(".")[0] in PACKAGES:
            for each in node.names:
                found = importlib.import_module(str(node.module))
                if not hasattr(found, each.name):
                    importlib.import_module(f"{node.module}.{each.name}")
                if isinstance(getattr(found, each.name), ModuleType):
                    modules[each.asname or each.name] = getattr(found, each.name)
    dotted = (node for node in tree if isinstance(node, ast.Attribute))
    used = {(node.value.id, node.attr) for node in dotted if isinstance(node.value, ast.Name)}
    missing = [
        f"{name}.{attribute}"
        for name, attribute in used
        if name in modules and not hasattr(modules[name], attribute)
    ]
    assert modules
    assert missing == []


IN_CI = "ball_on_rough_flat"


@pytest.mark.parametrize(
    "name", [name if name == IN_CI else pytest.param(name, marks=pytest.mark.nightly) for name in STATED]
)
def test_it_runs_and_prints_its_numbers(name: str, tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat", reason="the extra notebooks, which dev includes")
    nbclient = pytest.importorskip("nbclient", reason="the extra notebooks, which dev includes")
    pytest.importorskip("ipykernel", reason="the extra notebooks, which dev includes")
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    nbclient.NotebookClient(
        notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    printed = "".join(output["text"] for output in notebook.cells[-1].outputs if output["name"] == "stdout")
    assert agree(printed, STATED[name]), printed

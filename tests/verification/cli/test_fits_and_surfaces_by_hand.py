"""Fits and measured surfaces as tables, documents and pictures, from numbers made up by hand."""

from __future__ import annotations

import json
import math
from argparse import Namespace
from pathlib import Path
from types import SimpleNamespace as Made
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from refimpl.identification import Interval, Prediction, Row
from refimpl.identification.design import Proposal
from refimpl.identification.laws import Law
from refimpl.measured.inspection import PARAMETERS
from refimpl.sensitivities import surface_verdict
from refimpl.solution.patches import Patch
from verification.cli import arrays, half_space, identify, inspect, plot_surface


def rows(text: str) -> set[str]:
    return {" ".join(line.split()) for line in text.splitlines()}


BETA = Interval(0.2, 0.1, math.inf)
FIT: Any = Made(
    values={"tau": Interval(2e6, 1e6, 4e6), "beta": BETA, "hardness": Interval(3e8, 2e8, 5e8)},
    rows=(Row(8, 0.33, 0.01), Row(5, 0.36, 0.02)), is_identified=False, covariance=np.zeros((3, 3)),
    shares={"measurement": (3e5, 0.02, 1e7)}, method="ellipse", factor=2e-8, solves=11, passes=3,
    combination=Interval(0.24, 0.23, 0.26), residuals=(3, -2), deleted=(4, -2.5), degrees=1, chi_square=13,
    predictions=[Prediction(P, Interval(m, m - 0.05, m + 0.1)) for P, m in ((8, 0.3), (5, 0.4), (40, 0.5))],
    probability=0.0, laws=(Law("Coulomb", {}, 14, math.inf, 7),), warnings=("vague",),
    proposal=Proposal((2, 90), (0.25, math.inf)),
)  # fmt: skip


def test_a_fit_as_a_table_and_as_json() -> None:
    assert rows(identify.table(FIT)) > {
        "tau (MPa) 2 1 to 4", "beta 0.2 0.1 to inf", "hardness (MPa) 300 200 to 500", "warning: vague",
        "0.02 tau/MPa + beta 0.24 0.23 to 0.26", "measurement 0.3 0.02 10", "8 0.33 0.3 0.25 to 0.4 +3.0",
        "5 0.36 0.4 0.35 to 0.5 -2.0", "40 - 0.5 0.45 to 0.6 -", "Coulomb 14 inf 7",
    }  # fmt: skip
    found: Any = json.loads(json.dumps(identify.document(FIT), allow_nan=False))
    assert (found["tau"], found["beta"]["high"]) == ({"value": 2e6, "low": 1e6, "high": 4e6}, None)
    assert found["shares"] == {"measurement": {"tau": 3e5, "beta": 0.02, "hardness": 1e7}}
    assert (found["residuals"], found["deleted_residuals"]) == ([3, -2], [4, -2.5])
    assert (found["degrees_of_freedom"], found["solves"], found["passes"]) == (1, 11, 3)
    assert (found["laws"][0]["aicc"], found["laws"][0]["bic"]) == (None, 7)
    assert found["further_loads"] == {"loads": [2, 90], "tau": 0.25, "beta": None}


def test_the_table_of_an_inspected_surface() -> None:
    document = {
        "file": "a.sur", "format": "sur", "channel": "Z", "channels": ["Z", "I"], "points": [30, 20],
        "missing": 7, "pixel": [2e-6, 5e-7], "size": [6e-5, 1e-5], "unit": "um", "orientation": "",
        "level": "sphere", "slopes": [0.01, -0.02], "radius": 0.4, "notes": (),
        "window": {"points": [8, 9], "missing": 2}, "parameters": dict.fromkeys(PARAMETERS, 3e-12),
    }  # fmt: skip
    found: Any = Made(document=lambda: document)
    assert rows(inspect.table(found)) > {
        "channel Z; there are also I", "points 30 x 20, 7 missing", "pixel 2 um x 500 nm",
        "size 60 um x 10 um", "level sphere, slopes 0.01, -0.02, radius 400 mm",
        "window 8 x 9 points, 2 missing", "Sz 3 pm highest to lowest point",
    }  # fmt: skip


def test_the_picture_of_an_oblong_surface() -> None:
    """60 um along x and 10 along y; 1e-30 m^4 are a um^2 nm^2."""
    spectrum = Made(q=np.array([2e6]), C=np.array([4e-29]))
    found: Any = Made(z=np.arange(600.0).reshape(30, 20) * 1e-9, pixel=(2e-6, 5e-7), spectrum=spectrum)
    heights, power = Figure().subplots(1, 2)
    plot_surface.draw_map(heights, found)
    assert heights.images[0].get_extent() == pytest.approx((0, 60, 0, 10))
    assert np.asarray(heights.images[0].get_array())[1, 2] == pytest.approx(41)  # nm, at i = 2, j = 1
    plot_surface._spectrum(power, found)
    assert power.lines[0].get_xydata()[0] == pytest.approx((2, 40))


def test_what_is_assumed_of_a_surface_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """0.3 N on 3 x 2 mm are 50 kPa."""
    made, given = Made(load=0.3, lengths=(3e-3, 2e-3)), {"E": 5e9, "nu": 0.4, "tau": 3e6, "beta": 0.0}
    monkeypatch.setattr(surface_verdict, "pressed_on_a_flat", lambda *_, **__: made)
    (tmp_path / "a.csv").touch()
    options = dict.fromkeys(half_space.FILE_OPTIONS) | {"scene": str(tmp_path / "a.csv"), "grid": 8}
    note = half_space._posed(Namespace(**options))[1]
    assert "E = 200 GPa, nu = 0.3, tau = 0 MPa, beta = 0.1, nominal pressure 0.05 MPa" in note
    assert "E = 5 GPa, nu = 0.4, tau = 3 MPa, beta = 0," in half_space._posed(Namespace(**options | given))[1]


def test_patches_have_units_in_their_headers(tmp_path: Path) -> None:
    found: Any = Made(patches=lambda: [Patch(1, 4, 2e-6, 3.0, 1.5, 2.5, 4e-4, 5e-4, 0.25)])
    arrays.write_patches(found, tmp_path / "p.csv")
    assert (tmp_path / "p.csv").read_text().splitlines()[0] == (
        "label,elements,area [m^2],load [N],mean_pressure [Pa],max_pressure [Pa],x [m],y [m],plastic_share"
    )

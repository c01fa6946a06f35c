"""Products by near and far parts of the kernels against those by the whole kernel."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Array, Grid, Window
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.influence import window_influence
from refimpl.operators.near_far import TOLERANCE, NearFarInfluence

WINDOWS = [(256, 256), (240, 301)]


def fields(shape: tuple[int, int]) -> dict[str, Array]:
    rng = np.random.default_rng(7)
    x, y = (np.linspace(-1, 1, n) for n in shape)
    one = np.zeros(shape)
    one[shape[0] // 3, -1] = 1.0
    return {
        "random": rng.random(shape),
        "change": rng.standard_normal(shape),
        "sparse": rng.random(shape) * (rng.random(shape) < 0.05),
        "smooth": np.sqrt(np.maximum(1 - x[:, None] ** 2 - y**2, 0)),
        "one element": one,
        "everywhere": np.ones(shape),
    }


@pytest.mark.parametrize("shape", WINDOWS)
@pytest.mark.parametrize("kind", ["normal", "shear", "shear_across", "coupled"])
def test_both_parts_give_the_whole_product(shape: tuple[int, int], kind: str) -> None:
    """To 1e-11 of the largest displacement; measured: 3e-13 to 9.7e-12.

    White noise of both signs hardly displaces anything by shear: over that its error is up to 5e-11, and the
    displacement by the sizes of its tractions counts instead.
    """
    grid = Grid((shape[0] + 3, shape[1] + 9), ((shape[0] + 3) * 1e-6, (shape[1] + 9) * 1e-6))
    window = Window(3, 3 + shape[0], 4, 4 + shape[1])
    parts, whole = (cls(grid, 0.7, source=window) for cls in (NearFarInfluence, FFTInfluence))
    if kind == "coupled":
        found, expected = parts.coupled(-0.4), whole.coupled(-0.4)
    else:
        found, expected = getattr(parts, kind), getattr(whole, kind)
    for name, field in fields(shape).items():
        largest = np.abs(expected(field if kind == "normal" else np.abs(field))).max()
        assert np.abs(found(field) - expected(field)).max() <= 1e-11 * largest, name


def test_symmetric() -> None:
    """CG needs it: coarse points are asked by the weights that they were given."""
    operator = NearFarInfluence(Grid.square(1.0, 256), 0.0)
    p, q = np.random.default_rng(3).random((2, 256, 256))
    assert np.vdot(q, operator.normal(p)) == pytest.approx(np.vdot(p, operator.normal(q)), rel=1e-14)


@pytest.mark.parametrize(
    ("grid", "tolerance", "kind"),
    [
        (Grid.square(1.0, 240), TOLERANCE, NearFarInfluence),
        (Grid.square(1.0, 239), TOLERANCE, FFTInfluence),  # too few elements
        (Grid.square(1.0, 240), 0.9 * TOLERANCE, FFTInfluence),
        (Grid((240, 250), (1.0, 1.0)), TOLERANCE, FFTInfluence),  # not square
    ],
)
def test_serves_where_it_is_quicker(grid: Grid, tolerance: float, kind: type[FFTInfluence]) -> None:
    assert type(window_influence(grid, 0.0, tolerance=tolerance)) is kind
    assert type(window_influence(grid, 0.0)) is FFTInfluence


def test_counts_both_parts() -> None:
    counter = Counter()
    NearFarInfluence(Grid.square(1.0, 256), 0.0, counter=counter).normal(np.zeros((256, 256)))
    assert {name: n for name, n in counter.tally.items() if "kernel" not in name} == {
        "near normal": 1,
        "far normal": 1,
    }

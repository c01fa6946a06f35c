"""Threads: which transforms get them, and how little that changes."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from refimpl.grid import Array
from refimpl.operators import threads, transforms


def test_threads_are_the_cores_of_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 2, 5}, raising=False)
    assert threads.allowed_threads() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    assert threads.allowed_threads() == 7


@pytest.mark.parametrize("said", ["0", "-2", "", "\u00b2", "9" * 20, "1" * 5000, "2.0"])
def test_a_number_of_threads_that_is_none_counts_for_nothing(
    monkeypatch: pytest.MonkeyPatch, said: str
) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    by_itself = threads.allowed_threads()
    monkeypatch.setenv("OMP_NUM_THREADS", said)
    assert threads.allowed_threads() == by_itself


@pytest.mark.parametrize("said", ["3,1", " 3 "])
def test_the_first_number_of_a_list_counts(monkeypatch: pytest.MonkeyPatch, said: str) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", said)
    assert threads.allowed_threads() == 3


@pytest.mark.parametrize("said", [None, "2,1", "x"])
def test_the_environment_is_as_it_was_after_a_number_was_asked_for(
    monkeypatch: pytest.MonkeyPatch, said: str | None
) -> None:
    monkeypatch.setenv("DUCC0_NUM_THREADS", "5")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    if said is not None:
        monkeypatch.setenv("OMP_NUM_THREADS", said)
    by_itself = threads.allowed_threads()
    with threads.plain_number_of_threads():
        assert os.environ["OMP_NUM_THREADS"] == str(by_itself)
        assert os.environ["DUCC0_NUM_THREADS"] == "5"
    assert os.environ.get("OMP_NUM_THREADS") == said
    assert os.environ["DUCC0_NUM_THREADS"] == "5"


@pytest.mark.parametrize(("name", "said"), [("OMP_NUM_THREADS", "2,1"), ("DUCC0_NUM_THREADS", "-1")])
def test_no_number_of_threads_ends_in_an_assertion_of_a_library(name: str, said: str) -> None:
    code = "from refimpl.operators.transforms import fourier; import numpy, os; "
    code += f"assert os.environ[{name!r}] == {said!r}; fourier.plane(numpy.ones((200, 200)), (200, 200), 2)"
    done = subprocess.run([sys.executable, "-c", code], env=os.environ | {name: said}, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()


def test_small_transforms_have_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    assert transforms.threads(256 * 256) == 1
    assert transforms.threads(1024 * 1024) == 3


SOLVED = """
import sys
if sys.argv[2] == "SciPy":
    sys.modules["ducc0"] = None
import refimpl as rf
from refimpl.operators.transforms import fourier
assert type(fourier).__name__ == sys.argv[2]
fourier.worthwhile = 1
sys.stdout.buffer.write(rf.solve(rf.read_scene(sys.argv[1]), 48).pressure.tobytes())
"""


def solved(scene: str, library: str, threads: int) -> Array:
    """By a fresh process: ducc0 and BLAS read the number of threads when they are imported."""
    environment = os.environ | {"OMP_NUM_THREADS": str(threads)}
    asked = [sys.executable, "-c", SOLVED, scene, library]
    done = subprocess.run(asked, env=environment, capture_output=True, check=True)
    return np.frombuffer(done.stdout)


def test_threads_change_no_bit_of_scipy_and_the_last_ones_of_ducc0() -> None:
    one, two = (solved("table1-rough", "SciPy", threads) for threads in (1, 2))
    assert np.array_equal(one, two)
    pytest.importorskip("ducc0")
    one, two = (solved("rough-planes", "Ducc", threads) for threads in (1, 2))
    assert np.abs(one - two).max() < 1e-12 * one.max()


_INNER = """
import numpy as np
from refimpl.grid import inner
random = np.random.default_rng(1)
for n in (9_999, 10_000, 10_001, 200_000):
    print(inner(*random.standard_normal((2, 1, n))).hex())
"""


def test_inner_products_are_the_same_on_any_number_of_threads() -> None:
    """On either side of the length from which OpenBLAS takes more of them, where BLAS's own differ."""
    said = [
        subprocess.run(
            [sys.executable, "-c", _INNER],
            env=os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2")
    ]
    assert said[0] == said[1]
    assert len(said[0].splitlines()) == 4

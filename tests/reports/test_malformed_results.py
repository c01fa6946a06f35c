"""Result files that are damaged or dishonest: accepted only if consistent, and then shown."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from contextlib import suppress
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reports.generator import render
from reports.results import ResultFileError, check
from tests.reports.sample import ERRATUM, TEXTBOOK, UNJUDGED, case, results
from tests.verification.cli.children import Ended, one_line
from verification.cli import main

WHOLE = results(
    case("kernels/textbook-normal-fails", data=TEXTBOOK),
    case("a/2", "unavailable"),
    errata=[ERRATUM],
)
REPLACEMENTS: tuple[Any, ...] = (
    None, True, -1, 0, 5, 10**400, 1e308, float("nan"), float("inf"), "", "x", "\ud800", "\x00", "'", [], [1],
    [[]], ["x"], {}, {"x": 1}, {"x": {"y": []}},
)  # fmt: skip


def places(item: object, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if path:
        yield path
    entries = item.items() if isinstance(item, dict) else enumerate(item) if isinstance(item, list) else ()
    for key, entry in entries:
        yield from places(entry, (*path, key))


def replaced(document: dict[str, Any], path: tuple[Any, ...], value: object) -> dict[str, Any]:
    made = copy.deepcopy(document)
    holder: Any = made
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    return made


def shown_or_refused(document: object, against: object = None) -> None:
    """Any other end than a refusal fails the test."""
    with suppress(ResultFileError):
        check(document)
        render(document, {}, against)


PLACES = list(places(WHOLE))


def test_every_field_with_every_other_kind_of_value_is_checked() -> None:
    for path, value in product(PLACES, REPLACEMENTS):
        with suppress(ResultFileError):  # and nothing else
            check(replaced(WHOLE, path, value))


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # logarithms of what is no error
@settings(max_examples=5, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.sampled_from(PLACES), st.sampled_from(REPLACEMENTS), st.booleans())
def test_what_passes_the_check_is_shown(path: tuple[Any, ...], value: object, older: bool) -> None:
    made = replaced(WHOLE, path, value)
    shown_or_refused(WHOLE if older else made, made if older else None)


DISHONEST = {
    "error above the tolerance": {"error": 5.0, "value": 6.0, "tolerance": 1e-9},
    "error not that of the value": {"value": 6.0, "error": 0.0},
    "no error": {"error": None},
    "no number": {"error": float("nan")},
    "failed although within": {"status": "fail", "value": 1.01},
    "below the merit": {"metric": "at_least", "reference": None, "value": 0.05, "error": 0.05},
    "uncertain reference": {"reference_uncertainty": 0.2},
    "not judged, with a number": {"status": "unavailable", "value": 1.0},
    "negative tolerance": {"tolerance": -1.0},
}


@pytest.mark.parametrize("name", DISHONEST)
def test_a_status_that_does_not_follow_from_the_numbers_is_refused(name: str) -> None:
    with pytest.raises(ResultFileError):
        check(results(case("a/1") | DISHONEST[name]))


def test_a_case_disproved_before_a_number_was_found_is_a_result() -> None:
    """Its note says by what; without one, or with half of the numbers, the file is refused."""
    found = case("a/1", "fail") | UNJUDGED | {"note": "the area is 2, 3 in the committed comparison"}
    check(results(found))
    shown_or_refused(results(found), None)
    for half in ({"note": ""}, {"value": 1.0}, {"status": "pass"}):
        with pytest.raises(ResultFileError):
            check(results(found | half))


def test_data_that_its_figure_cannot_show_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = results(case("kernels/textbook-normal-fails", data=TEXTBOOK | {"production": ["x", "y", "z"]}))
    (tmp_path / "r.json").write_text(json.dumps(made))
    (none := tmp_path / "none").mkdir()
    command = ["report", "--results", str(tmp_path / "r.json"), "--committed", str(none)]
    assert main([*command, "--output", str(tmp_path / "out")]) == 2
    one_line(Ended(2, capsys.readouterr().err), "data of case 'kernels/textbook-normal-fails'", 2)

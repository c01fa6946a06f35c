"""On paper nothing scrolls: tables of many columns are set smaller, or their last ones would be cut off."""

from __future__ import annotations

import re

from reports.generator import render
from reports.result_files import committed
from tests.reports.sample import case, results

TABLE = re.compile(
    r'<table class="(?:sortable)?(?: short)?( wide)?">\s*<caption[^>]*>[^<]*</caption>'
    r"\s*<thead><tr>(.*?)</tr>",
    flags=re.S,
)


def test_tables_of_more_than_eight_columns_are_set_small() -> None:
    page = render(results(case("a/1")), {"benchmarks": committed("benchmarks")})
    columns = [(head.count("<th"), bool(wide)) for wide, head in TABLE.findall(page)]
    assert (13, True) in columns
    assert all(wide is (count > 8) for count, wide in columns)
    paper = page.partition("@media print")[2].partition("\n}")[0]
    assert ".wide { font-size" in paper
    assert "th { white-space: normal; }" in paper

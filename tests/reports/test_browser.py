"""The whole report in a real browser: axe-core, widths, dark and light, and what its script does."""

from __future__ import annotations

from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from tests.reports.browser import NEEDS_BROWSER, answer

pytestmark = NEEDS_BROWSER
AUDIT = """
  document.querySelectorAll("details").forEach((shown) => { shown.open = true; });
  const found = await axe.run(document, { resultTypes: ["violations"] });
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const seen = (rule) => rule.nodes.slice(0, 3).map((node) => node.html.slice(0, 200)).join(" | ");
  const named = (rule) => `${rule.id}: ${seen(rule)}`;
  return { dark, passes: found.passes.map((rule) => rule.id), violations: found.violations.map(named) };
"""
OVERFLOW = """
  const root = document.documentElement, width = root.clientWidth;
  const beyond = (shown) => shown.getBoundingClientRect().right > width + 1 && !shown.closest(".scroll, pre");
  const measure = () => [root.scrollWidth - width, [...document.querySelectorAll("body *")].filter(beyond)
    .map((shown) => shown.outerHTML.slice(0, 150))];
  const closed = measure();
  document.querySelectorAll("details").forEach((shown) => { shown.open = true; });
  const unreachable = [...document.querySelectorAll(".scroll")].filter((shown) => shown.tabIndex !== 0
    && shown.scrollWidth > shown.clientWidth).length;
  return { width, closed, open: measure(), unreachable };
"""
USE = """
  const table = document.querySelector("table.claims"), button = table.tHead.querySelector("button");
  const firsts = () => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
  button.click();
  const up = firsts();
  button.click();
  const down = firsts();
  const skip = document.querySelector("a");
  const filter = document.getElementById("filter");
  const checks = [...document.querySelectorAll("#checks > details")];
  filter.value = "kernels/";
  filter.dispatchEvent(new Event("input"));
  const kept = checks.filter((check) => !check.hidden).map((check) => check.firstElementChild.textContent);
  filter.value = "";
  filter.dispatchEvent(new Event("input"));
  location.hash = checks[5].id;
  await new Promise((resolve) => setTimeout(resolve, 50));
  const order = [...document.querySelectorAll("a[href], button, input, summary, [tabindex]")];
  return {
    up, down, kept, skip: [skip.textContent, skip.getAttribute("href")], opened: checks[5].open,
    shown: checks.filter((check) => !check.hidden).length, checks: checks.length,
    orders: [...new Set(order.map((shown) => shown.tabIndex))],
    nameless: [...document.querySelectorAll("button")].filter((shown) => !shown.textContent.trim()).length,
  };
"""


def axe() -> str:
    """The script of axe-core, the newest of the packages that carry it."""
    for package in ("axe_playwright_python", "axe_core_python"):
        if find_spec(package) is not None:
            return resources.files(package).joinpath("axe.min.js").read_text(encoding="utf-8")
    pytest.skip("axe-core-python, of the extra 'dev', is not installed")


def audited(page: str, folder: Path, width: int, scheme: str) -> Any:
    """What axe-core finds on the page."""
    return answer(
        page.replace("</body>", f"<script>{axe()}</script></body>", 1), AUDIT, folder, width, scheme
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("width", "scheme"), [(1280, "dark"), pytest.param(420, "light", marks=pytest.mark.nightly)]
)
def test_axe_finds_nothing(html: str, tmp_path: Path, width: int, scheme: str) -> None:
    found = audited(html, tmp_path, width, scheme)
    assert found["dark"] is (scheme == "dark")
    assert found["violations"] == []
    assert {"color-contrast", "button-name", "svg-img-alt"} <= set(found["passes"])


@pytest.mark.slow
@pytest.mark.parametrize("width", [1280, 420])
def test_nothing_is_wider_than_the_window(html: str, tmp_path: Path, width: int) -> None:
    found = answer(html, OVERFLOW, tmp_path, width)
    assert found["width"] in (width, width - 15)  # a scroll bar
    assert found["closed"] == [0, []]
    assert found["open"] == [0, []]
    assert found["unreachable"] == 0


def test_what_is_too_wide_is_noticed(tmp_path: Path) -> None:
    page = "<!doctype html><html><body><main><p style='width: 600px'>x</p></main></body></html>"
    assert answer(page, OVERFLOW, tmp_path, 420)["closed"][0] > 0


@pytest.mark.slow
def test_tables_sort_checks_are_filtered_and_links_open_them(html: str, tmp_path: Path) -> None:
    found = answer(html, USE, tmp_path)
    assert found["skip"] == ["Skip to the results", "#main"]
    assert len(found["up"]) > 50
    assert found["up"] == found["down"][::-1]
    assert found["kept"]
    assert all("kernels/" in name for name in found["kept"])
    assert found["shown"] == found["checks"] > len(found["kept"])
    assert found["opened"]
    assert found["orders"] == [0]  # the order of the keyboard is that of the page
    assert found["nameless"] == 0

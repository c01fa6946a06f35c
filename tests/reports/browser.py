"""A page in an installed browser: a script runs in it, and what the script returns comes back as JSON.

The page stands in a frame, as windows of a headless browser are never narrower than 500 px.
"""

from __future__ import annotations

import html
import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest

from verification.cli.pdf import BROWSERS, browser

FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking")
PATIENCE = "--virtual-time-budget=100000"  # ms of the page's own clock, which stops while a script computes
SCHEMES = {
    "dark": "--blink-settings=preferredColorScheme=0",
    "light": "--blink-settings=preferredColorScheme=1",
}
INSIDE = """<script>addEventListener("load", async () => {
  const answer = await (async () => { %s })().catch((fault) => ({ fault: String(fault) }));
  parent.postMessage(JSON.stringify(answer), "*");
});</script>"""
OUTSIDE = """<!doctype html><body><script>addEventListener("message", (event) => {
  const answer = document.createElement("pre");
  answer.id = "answer";
  answer.textContent = event.data;
  document.body.replaceChildren(answer);
});</script><iframe src="page.html" style="width: %dpx; height: 900px; border: 0"></iframe></body>"""


NEEDS_BROWSER = pytest.mark.skipif(
    browser() is None, reason=f"no browser: none of {', '.join(BROWSERS)} is installed"
)
"""Mark of tests in a browser: they are skipped before the page is made."""


def answer(page: str, script: str, folder: Path, width: int = 1280, scheme: str = "light") -> Any:
    """The value that the script returns once the page is loaded, in a frame of the width (px)."""
    inside = page.replace("</body>", INSIDE % script + "</body>", 1)
    (folder / "page.html").write_text(inside, encoding="utf-8")
    frame = folder / "frame.html"
    frame.write_text(OUTSIDE % width, encoding="utf-8")
    command = [str(browser()), *FLAGS, PATIENCE, SCHEMES[scheme], f"--user-data-dir={folder}/profile"]
    size = f"--window-size={width + 100},1000"
    done = subprocess.run(
        [*command, size, "--dump-dom", frame.as_uri()], capture_output=True, text=True, timeout=600
    )
    found = re.search(r'<pre id="answer">(.*?)</pre>', done.stdout, flags=re.S)
    if found is None:
        raise RuntimeError(f"the page gave no answer: {done.stderr[-500:]}")
    value = json.loads(html.unescape(found[1]))
    if isinstance(value, dict) and "fault" in value:
        raise RuntimeError(value["fault"])
    return value

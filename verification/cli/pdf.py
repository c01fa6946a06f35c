"""The report on paper: printed by an installed browser, then rewritten by pikepdf without loss.

The browser writes every element of the tag tree as an object of its own, uncompressed: half of its file.
pikepdf packs the objects into compressed streams; pages, tags, outline and links stay as they are.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path

from verification.cli.output import refusal

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
PAPERS = {"a4": "A4", "letter": "letter"}
"""Sizes of paper by the option's value, as CSS names them."""
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--no-pdf-header-footer",
    "--generate-pdf-document-outline",
)


def browser() -> str | None:
    """Path of the first installed browser of `BROWSERS`, or None."""
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def compacts() -> bool:
    """True where pikepdf is installed."""
    return find_spec("pikepdf") is not None


def printed(page: Path, paper: str = "a4") -> Path:
    """Print the HTML page on A4 or letter paper to a PDF beside it; the file appears whole or not at all.

    Raises InputError where no browser is installed or the browser fails.
    """
    target = page.with_suffix(".pdf").resolve()
    found = browser()
    if found is None:
        raise refusal("--pdf", True, f"an installed browser, one of {', '.join(BROWSERS)}")
    with tempfile.TemporaryDirectory() as folder:
        sized, made = Path(folder) / page.name, Path(folder) / "made.pdf"
        rule = f"<style>@page {{ size: {PAPERS[paper]}; }}</style>\n</head>"
        sized.write_text(page.read_text(encoding="utf-8").replace("</head>", rule, 1), encoding="utf-8")
        command = [found, *FLAGS, f"--user-data-dir={folder}/profile", f"--print-to-pdf={made}"]
        done = subprocess.run([*command, sized.as_uri()], capture_output=True)
        if done.returncode != 0 or not made.exists():
            said = done.stderr.decode(errors="replace").strip()[-200:]
            raise refusal("--pdf", True, f"a browser that prints ({said})")
        beside = target.with_name(f".{target.name}.new")
        if compacts():
            import pikepdf

            pikepdf.settings.set_flate_compression_level(9)
            packed = pikepdf.ObjectStreamMode.generate
            with pikepdf.open(made) as document:
                document.save(beside, object_stream_mode=packed, compress_streams=True, recompress_flate=True)
        else:
            shutil.copyfile(made, beside)
        os.replace(beside, target)
    return target

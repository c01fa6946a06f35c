"""Jobs of a tribologist, as scripts of documented commands: they run, and their outputs hold together."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.documents import ROOT
from tests.verification.cli.children import finished, until

JOBS = ROOT / "examples/jobs"
PATIENCE = 300.0  # s, on a busy machine; each takes a few on an idle one


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the jobs, as a user would copy them; this interpreter's console script comes first."""
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(ROOT), os.environ.get("PYTHONPATH", ""))))
    monkeypatch.setenv("MPLBACKEND", "agg")
    return Path(shutil.copytree(JOBS, tmp_path / "jobs"))


def run(folder: Path, name: str) -> str:
    command = ["bash", f"{name}.sh"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def document(folder: Path, name: str) -> Any:
    return json.loads((folder / name).read_text(encoding="utf-8"))


def table(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def rough(n: int, pixel: float, rms: float, seed: int) -> Any:
    q = 2 * np.pi * np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(n, pixel)], indexing="ij"))
    noise = np.random.default_rng(seed).normal(size=(n, n))
    z = np.fft.ifft2(np.fft.fft2(noise) * np.exp(-((q * 30e-6) ** 2) / 18.4)).real
    return rms * z / z.std()


def test_every_job_is_run_here_and_copies_no_data() -> None:
    assert {path.stem for path in JOBS.glob("*.sh")} == {
        "measured", "loads", "track", "arrays", "patches", "yield", "film",
    }  # fmt: skip
    assert {path.suffix for path in JOBS.iterdir()} == {".sh", ".toml"}
    assert all(os.access(path, os.X_OK) for path in JOBS.glob("*.sh"))


@pytest.mark.nightly
def test_a_sweep_is_interrupted_and_goes_on(job: Path) -> None:
    started = subprocess.Popen(
        ["bash", "loads.sh"], cwd=job, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a job in the background ignores it
    )  # fmt: skip
    until(PATIENCE, "ten runs", lambda: finished(job / "loads.sqlite") >= 10 or started.poll() is not None)
    os.killpg(started.pid, signal.SIGINT)  # Ctrl-C, of the whole group
    _, shown = started.communicate(timeout=PATIENCE)
    message = r"interrupted: (\d+) of 210 runs are kept in loads.sqlite; the same command resumes"
    stated = re.search(message, shown)
    assert stated is not None, shown
    assert "Traceback" not in shown
    kept = finished(job / "loads.sqlite")
    assert 10 <= kept == int(stated[1]) < 210
    assert not (job / "loads.csv").exists()
    printed = run(job, "loads")
    found = document(job, "loads.json")
    assert (found["found"], found["finished"], found["failures"]) == (kept, 210 - kept, {})
    made = table(job, "loads.csv")
    assert len({(r["realisation"], r["load [N]"], r["lower_rms [m]"]) for r in made}) == 210
    assert "error bar" in printed
    assert "scatter" in printed
    picture = (job / "loads.svg").read_text(encoding="utf-8")
    assert picture.count("LineCollection") >= 3  # the error bars of each curve
    light, heavy = (
        np.mean([float(row["friction_coefficient"]) for row in made if row["load [N]"] == load])
        for load in ("1.0", "100.0")
    )
    assert light > heavy  # adhesive shear matters less under a larger load


@pytest.mark.nightly
def test_a_ball_on_a_measured_flat_to_one_per_cent(job: Path) -> None:
    n, pixel = 128, 2e-6
    edge = f"{n * pixel * 1e6} µm"
    head = f"# Channel: Height\n# Width: {edge}\n# Height: {edge}\n# Value units: m"
    np.savetxt(job / "specimen.txt", rough(n, pixel, 0.1e-6, 3), header=head, comments="", encoding="utf-8")
    assert "128 x 128" in run(job, "measured")
    found = document(job, "measured.json")
    bar = math.fsum(found["uncertainty"]["friction_coefficient_corrected"].values())
    assert 0 < bar <= 0.01 * found["friction_coefficient_corrected"]
    # tau on the contact, and beta: the slopes of so smooth a surface change mu by less than 1 %
    expected = 0.2 + 0.3e6 * found["contact_area"] / 0.05
    assert found["friction_coefficient"] == pytest.approx(expected, rel=0.01)
    assert (job / "measured.png").stat().st_size > 20_000


@pytest.mark.nightly
def test_two_maps_along_a_track(job: Path) -> None:
    np.save(job / "slider.npy", rough(50, 4e-6, 0.3e-6, 1))
    np.save(job / "track.npy", rough(100, 4e-6, 0.5e-6, 2))
    run(job, "track")
    made = table(job, "track.csv")
    offsets = [float(row["sliding_offset [m]"]) for row in made]
    assert offsets == pytest.approx(np.arange(-80e-6, 81e-6, 20e-6), rel=1e-6, abs=1e-12)
    assert {row["status"] for row in made} <= {"converged", "cycled"}
    assert len({row["friction_coefficient"] for row in made}) == 9  # another contact at each place
    assert (job / "track.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("name", "made"), [("arrays", "fields.vtu"), ("patches", "patches.csv"), ("yield", "yield.csv")]
)
def test_a_job_writes_its_files(name: str, made: str, job: Path) -> None:
    pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    run(job, name)
    assert (job / made).stat().st_size > 1000


@pytest.mark.nightly
def test_friction_of_a_film_over_the_load_beside_an_experiment(job: Path) -> None:
    run(job, "film")
    made = [
        (float(row["load [N]"]), float(row["friction_coefficient_corrected"]))
        for row in table(job, "film.csv")
    ]
    slope = np.polyfit(*np.log(np.transpose(made)), 1)[0]
    assert slope == pytest.approx(-0.32, abs=0.01)  # measured, Singer and others 1990

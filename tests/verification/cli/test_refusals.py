"""Bad input ends in one line with status 2, before any work, and replaces no file."""

from __future__ import annotations

import errno
import io
import json
import os
from pathlib import Path

import pytest

from tests.reports import sample
from tests.verification.cli.commands import SCENE, refused, run

WEDGE = "appendix-a wedge --r 1 --theta-deg 0 --gamma-deg"
STRIP = "appendix-a strip --slope-deg 6.5 --wavelength 100 --position 0.25 --nu 0.3 --offsets=-3,3"
ELEMENT = "appendix-a element --slope-deg 9 --nu 0.3"
MAP = "appendix-a map"
PIXELS = "--unit um --pixel-size 1e-6"

COMMANDS = [
    ("", "required"),
    ("nonsense", "nonsense"),
    ("verify --tier nightly", "nightly"),
    ("verify --only none/*", "none/*"),
    ("verify --jobs 0", "--jobs = 0"),
    ("verify --json /no/such/folder/results.json", "/no/such/folder"),
    ("verify --json ''", "--json: expected a file's name, or '-' for standard output"),
    ("verify --export /dev/null/d --list", "no other action"),
    ("report --results no-such-file.json", "no-such-file.json"),
    ("appendix-a", "required"),
    (f"{WEDGE} 95", "--gamma-deg = 95.0: expected a slope angle of 0 to below 90 degrees"),
    (f"{WEDGE} 10 --theta-deg 10,85", "--theta-deg = 85.0: expected angles within the faces at +-80 degrees"),
    (f"{STRIP} --offsets nan", "--offsets: 'nan'"),
    (f"{MAP} --slopes-deg 6,50", "--slopes-deg = 50.0: expected 0.1 to 45 degrees"),
    (f"{ELEMENT} --upper-nu 0.3", "--upper-E = None: expected both"),
    (f"{ELEMENT} --nu nan", "--nu: 'nan' is not a finite number"),
    ("appendix-a surface hertz --pixel-size 1e-6", "--pixel-size = 1e-06"),
    ("appendix-a surface nothing.sur", "a surface's file"),
    (f"appendix-a surface heights.npy {PIXELS} --plot map.gif", "--plot"),
    ("identify hertz a.csv --loads '5;8'", "'5;8' is no list of numbers"),
    ("inspect heights.npy", "unit, pixel_size"),
    (f"inspect heights.npy {PIXELS} --size 1,2,3", "--size"),
    (f"inspect heights.npy {PIXELS} --fit cubist", "--fit"),
    (f"inspect heights.npy {PIXELS} --plot a.jpg", "--plot"),
    (f"inspect heights.npy {PIXELS} --json heights.npy", "--json"),
    ("solve no-such-scene", "table1-smooth"),
    ("solve hertz --approach 3e-6 --budget", "--approach = 3e-06: expected none with --budget"),
    ("solve hertz -1e-6", "-1e-6"),
    ("solve hertz --accuracy 0.1 --grid 8", "not allowed with"),
    ("solve hertz --grid 0", "grid = 0"),
    ("solve hertz --grid 48x", "--grid"),
    ("solve hertz --size 1e-3", "--size"),
    ("solve hertz --quantity contact_area", "--quantity = 'contact_area'"),
    ("solve hertz --plastic yes", "expected on or off"),
    ("solve hertz --explain --plot p.png", "--plot"),
    ("solve hertz --plot picture.jpg", ".png"),
    ("solve hertz --vtk surfaces.stl", ".vtu"),
    ("solve hertz --vtk /no/such/folder/s.vtu", "/no/such/folder"),
    ("solve hertz --npz s.csv", "--npz"),
    ("sweep", "STUDY"),
    ("sweep no-such-study", "study"),
    ("sweep table3 --workers 0", "--workers"),
    ("sweep table3 --store ''", "--store: expected a file's name"),
    ("sweep table3 --csv nowhere/t.csv", "--csv"),
    ("sweep table3 --csv x.parquet", ".parquet"),
    ("sweep study.toml --plot mu.png --x rms", "--x"),
    ("sweep study.toml --x load", "--x"),
]


@pytest.mark.parametrize(("command", "says"), COMMANDS)
def test_commands(command: str, says: str, folder: Path) -> None:
    before = {path.name for path in folder.iterdir()}
    refused(command, says)
    assert {path.name for path in folder.iterdir()} == before


def test_what_a_terminal_would_obey_is_escaped() -> None:
    for words in (["hertz", "\x1b]0;owned\x07"], ["\x1b]0;owned\x07\nroot# rm -rf"]):
        done = run("solve '" + "' '".join(words) + "'")
        assert (done.status, done.err.count("\n")) == (2, 1)
        assert not {"\x1b", "\x07"} & set(done.err)


def test_a_study_beyond_the_memory_is_refused_before_its_store_is_made(folder: Path) -> None:
    Path("study.toml").write_text('scene = "table1-rough"\n[vary]\ngrid = [500000, 1000000]\n')
    refused("sweep study.toml", "GB")
    assert not Path("study.sqlite").exists()


@pytest.mark.parametrize("command", ["identify hertz", "identify hertz data.csv --store", "report --results"])
@pytest.mark.parametrize("file", ["/dev/full", "pipe"])
def test_a_device_or_a_pipe_has_no_end(command: str, file: str, folder: Path) -> None:
    Path("data.csv").write_text("load,mu,u_mu\n5,0.4,0.01\n11,0.3,0.01\n")
    os.mkfifo("pipe")
    refused(f"{command} {file}", f"= '{file}': expected a regular file of at most")


@pytest.mark.parametrize("text", ["[1", '{"format": "rough-friction identify 2", "solves": {"a": 1}}'])
def test_stores_of_fits(text: str, folder: Path) -> None:
    Path("data.csv").write_text("load,mu,u_mu\n5,0.4,0.01\n11,0.3,0.01\n")
    Path("store.json").write_text(text)
    refused("identify table1-smooth data.csv --store store.json", "store")


RESULTS = sample.results(sample.case("a/1"), sample.case("a/2", "fail"))
WHOLE = json.dumps(RESULTS)
CORRUPTED = {
    "cut": WHOLE[: len(WHOLE) // 2], "list": "[]", "deep": "[" * 100_000, "binary": "\x00\x01\x02",
    "long number": '{"seconds": ' + "1" * 5000 + "}", "wrong counts": WHOLE.replace('"pass": 1', '"pass": 7'),
    "empty run": json.dumps(sample.results()),
}  # fmt: skip


@pytest.mark.parametrize("name", CORRUPTED)
def test_result_files(name: str, folder: Path) -> None:
    Path("r.json").write_text(CORRUPTED[name])
    refused("report --results r.json --output out", "--results = 'r.json'")
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("option", "bad", "named"),
    [
        ("--against", "null", "old.json"),
        ("--committed", CORRUPTED["wrong counts"], "kept/coverage_corrected.json"),
        ("--committed", "{", "kept/coverage_corrected.json"),
        ("--committed", json.dumps({"tail": []}), "kept"),
    ],
)
def test_the_file_that_is_refused_is_named_by_its_option(
    option: str, bad: str, named: str, folder: Path
) -> None:
    Path("kept").mkdir()
    files = {"--results": "r.json", "--against": "old.json", "--committed": "kept/coverage_corrected.json"}
    for role, name in files.items():
        Path(name).write_text(bad if role == option else WHOLE)
    command = "report --results r.json --against old.json --committed kept --output out"
    refused(command, f"{option} = '{named}'")
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("unreadable", "command"),
    [
        ("scene.toml", "solve scene.toml --grid 8"),
        ("heights.npy", "solve measured.toml --grid 8"),
        ("heights.npy", "sweep study.toml"),
        ("r.json", "report --results r.json"),
        ("long.json", "report --results r.json --committed kept"),
    ],
)
def test_an_input_that_may_not_be_read_is_named(
    unreadable: str, command: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Simulated in `open`, as a file mode does not stop root."""
    Path("study.toml").write_text('scene = "measured.toml"\n[vary]\ngrid = [8]\n')
    Path("kept").mkdir()
    for name in ("r.json", "old.json", "kept/long.json"):
        Path(name).write_text(WHOLE)
    real = io.open

    def opens(path: object, *args: object, **options: object) -> object:
        if isinstance(path, str | Path) and Path(path).name == unreadable:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return real(path, *args, **options)  # type: ignore[call-overload]  # passed on as they are

    monkeypatch.setattr(io, "open", opens)  # of `Path.open`
    monkeypatch.setattr("builtins.open", opens)  # of numpy
    done = run(command)
    assert (done.status, done.err.count("\n")) == (2, 1)
    assert all(words in done.err for words in (unreadable, "a file that can be read", "Permission denied"))


IN_PLACE_OF_INPUTS = [
    ("solve scene.toml --json", ["scene.toml", "link.toml", "sub/../scene.toml"]),
    ("solve measured.toml --json", ["heights.npy"]),
    ("solve scene.png --grid 8 --plot", ["scene.png"]),
    *(
        (f"sweep study.toml {option}", ["study.toml", "measured.toml", "heights.npy"])
        for option in ("--store", "--csv", "--json")
    ),
    ("report --results r.json --output out --json", ["r.json"]),
]


@pytest.mark.parametrize(("command", "names"), IN_PLACE_OF_INPUTS)
def test_an_output_is_no_input(command: str, names: list[str], folder: Path) -> None:
    Path("study.toml").write_text('scene = "measured.toml"\n[vary]\ngrid = [8, 16]\n')
    Path("link.toml").symlink_to("scene.toml")
    Path("sub").mkdir()
    Path("scene.png").write_text(SCENE)
    Path("r.json").write_text(WHOLE)
    before = {path.name: path.read_bytes() for path in folder.glob("*.*")}
    for name in names:
        refused(f"{command} {name}", f"{command.split()[-1]} = '{name}'")
    assert {path.name: path.read_bytes() for path in folder.glob("*.*")} == before


@pytest.mark.parametrize(
    "command",
    [
        "solve hertz --vtk a.vtu --json sub/../a.vtu",
        "solve hertz --vtk old.vtu --json link.json",
        "solve hertz --vtk old.vtu --json hard.json",
        "sweep study.toml --store study.sqlite --csv study.sqlite",
        "sweep study.toml --csv x.csv --json ./x.csv",
        "sweep study.toml --csv - --json -",
        "sweep study.toml --store s.db --csv s.db-wal",
        "report --results r.json --output out --json out/report.html",
    ],
)
def test_no_two_outputs_are_one_file(command: str, folder: Path) -> None:
    for name in ("sub", "out"):
        Path(name).mkdir()
    Path("old.vtu").write_text("old")
    Path("link.json").symlink_to("old.vtu")
    Path("hard.json").hardlink_to("old.vtu")
    Path("r.json").write_text(WHOLE)
    before = sorted(path.name for path in folder.rglob("*"))
    done = run(command)
    options = [word for word in command.split() if word.startswith("--") and word != "--results"]
    assert (done.status, done.err.count("\n")) == (2, 1)
    assert all(option in done.err for option in options)
    assert sorted(path.name for path in folder.rglob("*")) == before
    assert Path("old.vtu").read_text() == "old"


def test_a_report_is_no_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("r.json").write_text(WHOLE)
    Path("out").write_text("a file")
    monkeypatch.setattr("reports.generator.render", lambda *_: pytest.fail("drawn, which takes a minute"))
    for name in ("out", "out/below"):
        refused(f"report --results r.json --output {name}", "--output")
    assert Path("out").read_text() == "a file"

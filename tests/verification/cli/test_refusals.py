"""Bad input ends in one line with status 2, before any work, and replaces no file."""

from __future__ import annotations

import errno
import io
import json
import os
from pathlib import Path

import pytest

from tests.reports import sample
from tests.verification.cli.commands import OBLONG, SCENE, refused, run

WEDGE = "appendix-a wedge --r 1 --theta-deg 0 --gamma-deg"
STRIP = "appendix-a strip --slope-deg 6.5 --wavelength 100 --position 0.25 --nu 0.3 --offsets=-3,3"
FEM = STRIP.replace("strip", "fem")
ELEMENT = "appendix-a element --slope-deg 9 --nu 0.3"
LOOK_UP = "appendix-a look-up --slope-deg 6.5 --position 0.25 --nu 0.3 --wavelength"
MAP = "appendix-a map"
PIXELS = "--unit um --pixel-size 1e-6"

COMMANDS = [
    ("", "required"),
    ("nonsense", "nonsense"),
    ("verify --tier nightly", "nightly"),
    ("verify --only none/*", "none/*"),
    ("verify --jobs 0", "--jobs = 0"),
    ("verify --jobs 99999", "--jobs = 99999: expected 1 to 1024 worker processes"),
    ("verify --json /no/such/folder/results.json", "/no/such/folder"),
    ("verify --json .", "directory"),
    ("verify --json ''", "--json: expected a file's name, or '-' for standard output"),
    ("verify --export /dev/null/d --list", "no other action"),
    ("report --results no-such-file.json", "no-such-file.json"),
    ("report --results .", "a file that can be read (Is a directory)"),
    ("appendix-a", "required"),
    (f"{WEDGE} 10 --r x", "'x'"),
    (f"{WEDGE} 95", "--gamma-deg = 95.0: expected a slope angle of 0 to below 90 degrees"),
    (f"{WEDGE} 45 --r 1e308 --half-width 1e-300", "--r = 1e+308: expected positive distances of 1e-300 to"),
    (f"{WEDGE} 10 --theta-deg 10,85", "--theta-deg = 85.0: expected angles within the faces at +-80 degrees"),
    (f"{FEM} --slope-deg 50", "--slope-deg = 50.0: expected a maximum slope of 0 to 45 deg"),
    (f"{STRIP} --offsets nan", "--offsets: 'nan'"),
    (f"{MAP} --slopes-deg 6,50", "--slopes-deg = 50.0: expected 0.1 to 45 degrees"),
    (f"{MAP} --slopes-deg 2,4 --jobs 1", "--slopes-deg"),
    (f"{MAP} --wavelengths 5,10001", "4 to 10000 half-widths"),
    (f"{MAP} --positions 0,0.51", "0 to 0.5 wavelengths"),
    (f"{MAP} --jobs 0", "--jobs"),
    (f"{MAP} --jobs 99999", "--jobs = 99999"),
    (f"{ELEMENT} --upper-nu 0.3", "--upper-E = None: expected both"),
    (f"{ELEMENT} --upper-nu 0.3 --upper-E 0", "--upper-E = 0.0"),
    (f"{ELEMENT} --upper-E 200", "--upper-nu"),
    (f"{ELEMENT} --nu nan", "--nu: 'nan' is not a finite number"),
    (f"{LOOK_UP} 64 --E 1e308 --upper-E 1e-320 --upper-nu 0.2", "--E = 1e+308"),
    (f"{LOOK_UP} inf", "--wavelength: 'inf' is not a finite number"),
    ("appendix-a surface hertz --pixel-size 1e-6", "--pixel-size = 1e-06"),
    ("appendix-a surface hertz --nu 0.2", "--nu"),
    ("appendix-a surface nothing.sur", "a surface's file"),
    (f"appendix-a surface heights.npy {PIXELS} --plot map.gif", "--plot"),
    ("identify hertz a.csv --loads '5;8'", "'5;8' is no list of numbers"),
    ("inspect heights.npy", "unit, pixel_size"),
    ("inspect heights.npy --unit furlong --pixel-size 1", "unit = 'furlong'"),
    (f"inspect heights.npy {PIXELS} --size inf", "size = inf"),
    (f"inspect heights.npy {PIXELS} --centre 1e308 --size 1e-6", "centre = 1e+308"),
    ("inspect heights.npy --pixel-size wide", "--pixel-size"),
    (f"inspect heights.npy {PIXELS} --size 1", "at most the measured"),
    (f"inspect heights.npy {PIXELS} --size 1,2,3", "--size"),
    (f"inspect heights.npy {PIXELS} --fit cubist", "--fit"),
    (f"inspect heights.npy {PIXELS} --plot a.jpg", "--plot"),
    (f"inspect heights.npy {PIXELS} --json heights.npy", "--json"),
    ("solve no-such-scene", "table1-smooth"),
    ("solve hertz --approach -inf", "approach = -inf"),
    ("solve hertz --approach --budget", "--approach"),
    ("solve hertz --approach 3e-6 --budget", "--approach = 3e-06: expected none with --budget"),
    ("solve hertz -1e-6", "-1e-6"),
    ("solve hertz --accuracy -1e-3", "accuracy = -0.001"),
    ("solve hertz --accuracy 0.1 --grid 8", "not allowed with"),
    ("solve hertz --grid 0", "grid = 0"),
    ("solve hertz --grid 0 --explain", "grid = 0"),
    ("solve hertz --grid 48x", "--grid"),
    ("solve hertz --size 1e-3", "--size"),
    ("solve hertz --size 1e-3x0", "size = "),
    ("solve hertz --grid 8 --quantity contact_area", "--quantity = 'contact_area'"),
    ("solve hertz --quantity contact_area", "--quantity = 'contact_area'"),
    ("solve hertz --plastic yes", "expected on or off"),
    ("solve hertz --plastic on", "hardness"),
    ("solve hertz --explain --plot p.png", "--plot"),
    ("solve hertz --explain --budget", "--budget"),
    ("solve hertz --explain --strict", "--strict"),
    ("solve hertz --plot picture.jpg", ".png"),
    ("solve hertz --plot -", "--plot"),
    ("solve hertz --vtk surfaces.stl", ".vtu"),
    ("solve hertz --vtk -", "--vtk"),
    ("solve hertz --vtk /no/such/folder/s.vtu", "/no/such/folder"),
    ("solve hertz --npz s.csv", "--npz"),
    ("solve hertz --netcdf s.npz", "--netcdf"),
    ("sweep", "STUDY"),
    ("sweep no-such-study", "study"),
    ("sweep table3 --workers 0", "--workers"),
    ("sweep table3 --workers 99999", "--workers = 99999"),
    ("sweep table3 --store ''", "--store: expected a file's name"),
    ("sweep table3 --store -", "--store"),
    ("sweep table3 --csv nowhere/t.csv", "--csv"),
    ("sweep table3 --csv x.parquet", ".parquet"),
    ("sweep table3 --parquet x.csv", ".csv"),
    ("sweep table3 --parquet -", "--parquet"),
    ("sweep table3 --json x.sqlite", ".sqlite"),
    ("sweep study.toml --plot mu.jpg", ".svg"),
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


@pytest.mark.parametrize(
    ("text", "old", "new", "says"),
    [
        (SCENE, "[friction]", '[tolerances]\n"upper.colour" = 0.1\n[friction]', "upper.colour"),
        (OBLONG, "[2e-3, 1e-3]", "2e-3", "size"),
    ],
)
def test_scene_files(text: str, old: str, new: str, says: str, tmp_path: Path) -> None:
    assert old in text
    path = tmp_path / "bad.toml"
    path.write_text(text.replace(old, new, 1))
    refused(f"solve {path} --json {tmp_path}/s.json", says)
    assert list(tmp_path.iterdir()) == [path]


def test_a_study_beyond_the_memory_is_refused_before_its_store_is_made(folder: Path) -> None:
    Path("study.toml").write_text('scene = "table1-rough"\n[vary]\ngrid = [500000, 1000000]\n')
    refused("sweep study.toml", "GB")
    assert not Path("study.sqlite").exists()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("load,mu,u_mu\n-5,0.1,0.01\n9,0.1,0.01\n", "a positive number"),
        ("load,mu,u_mu\n5,0.1,1e300\n9,0.1,0.01\n", "data line 2: u_mu = 1e+300"),
        ("load,mu,u_mu\n0.005,0.1,0.01\n9,0.1,0.01\n", "kN"),
    ],
)
def test_tables_of_measured_friction(text: str, says: str, folder: Path) -> None:
    Path("data.csv").write_text(text)
    refused("identify table1-smooth data.csv --grid 48", says)


@pytest.mark.parametrize("command", ["identify hertz", "identify hertz data.csv --store", "report --results"])
@pytest.mark.parametrize("file", ["/dev/full", "pipe"])
def test_a_device_or_a_pipe_has_no_end(command: str, file: str, folder: Path) -> None:
    Path("data.csv").write_text("load,mu,u_mu\n5,0.4,0.01\n11,0.3,0.01\n")
    os.mkfifo("pipe")
    refused(f"{command} {file}", f"= '{file}': expected a regular file of at most")


@pytest.mark.parametrize("text", ["{}", "[1", '{"format": "rough-friction identify 2", "solves": {"a": 1}}'])
def test_stores_of_fits(text: str, folder: Path) -> None:
    Path("data.csv").write_text("load,mu,u_mu\n5,0.4,0.01\n11,0.3,0.01\n")
    Path("store.json").write_text(text)
    refused("identify table1-smooth data.csv --store store.json", "store")


RESULTS = sample.results(sample.case("a/1"), sample.case("a/2", "fail"))
WHOLE = json.dumps(RESULTS)
CORRUPTED = {
    "cut": WHOLE[: len(WHOLE) // 2], "empty": "", "null": "null", "list": "[]", "number": "1e400",
    "deep": "[" * 100_000, "binary": "\x00\x01\x02", "other format": '{"format": "another"}',
    "long number": '{"seconds": ' + "1" * 5000 + "}", "wrong counts": WHOLE.replace('"pass": 1', '"pass": 7'),
    "no cases": WHOLE.replace('"cases"', '"kases"'),
    **{f"{key} {value}": json.dumps(RESULTS | {key: value}) for key, value in (
        ("cases", 3), ("cases", ["x"]), ("counts", []), ("provenance", None), ("errata", [1]))},
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
        ("--results", CORRUPTED["wrong counts"], "r.json"),
        ("--against", CORRUPTED["wrong counts"], "old.json"),
        ("--against", "null", "old.json"),
        ("--committed", CORRUPTED["wrong counts"], "kept/coverage_corrected.json"),
        ("--committed", "[]", "kept/coverage_corrected.json"),
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
        ("measured.toml", "sweep study.toml"),
        ("study.toml", "sweep study.toml"),
        ("heights.npy", "sweep study.toml"),
        ("r.json", "report --results r.json"),
        ("old.json", "report --results r.json --against old.json"),
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
    ("solve scene.vtu --grid 8 --vtk", ["scene.vtu"]),
    *(
        (f"sweep study.toml {option}", ["study.toml", "measured.toml", "heights.npy"])
        for option in ("--store", "--csv", "--parquet", "--json")
    ),
    ("report --results r.json --output out --json", ["r.json"]),
]


@pytest.mark.parametrize(("command", "names"), IN_PLACE_OF_INPUTS)
def test_an_output_is_no_input(command: str, names: list[str], folder: Path) -> None:
    Path("study.toml").write_text('scene = "measured.toml"\n[vary]\ngrid = [8, 16]\n')
    Path("link.toml").symlink_to("scene.toml")
    Path("sub").mkdir()
    for name in ("scene.png", "scene.vtu"):
        Path(name).write_text(SCENE)
    Path("r.json").write_text(WHOLE)
    before = {path.name: path.read_bytes() for path in folder.glob("*.*")}
    for name in names:
        refused(f"{command} {name}", f"{command.split()[-1]} = '{name}'")
    assert {path.name: path.read_bytes() for path in folder.glob("*.*")} == before


@pytest.mark.parametrize(
    "command",
    [
        "solve hertz --vtk a.vtu --json a.vtu",
        "solve hertz --vtk a.vtu --json sub/../a.vtu",
        "solve hertz --vtk old.vtu --json link.json",
        "solve hertz --vtk old.vtu --json hard.json",
        "sweep study.toml --store keep.sqlite --csv keep.sqlite",
        "sweep study.toml --store study.sqlite --csv study.sqlite",
        "sweep study.toml --csv x.csv --json x.csv",
        "sweep study.toml --csv x.csv --json ./x.csv",
        "sweep study.toml --csv - --json -",
        *(f"sweep study.toml --store s.db --csv s.db{end}" for end in ("", "-wal", "-shm", "-journal")),
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


def test_the_default_store_is_no_input(folder: Path) -> None:
    Path("study.sqlite").write_text('scene = "hertz"\n[vary]\ngrid = [8]\n')
    refused("sweep study.sqlite", "--store = 'study.sqlite'")


def test_a_report_is_no_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("r.json").write_text(WHOLE)
    Path("out").write_text("a file")
    monkeypatch.setattr("reports.generator.render", lambda *_: pytest.fail("drawn, which takes a minute"))
    for name in ("out", "out/below"):
        refused(f"report --results r.json --output {name}", "--output")
    assert Path("out").read_text() == "a file"

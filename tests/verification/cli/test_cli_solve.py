"""`rough-friction solve`: its table, JSON, picture and VTK file tell the same as the solution itself."""

from __future__ import annotations

import dataclasses
import json
import math
import re
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from PIL import Image

import refimpl
from refimpl.accuracy.refinement import QUANTITIES
from refimpl.planning.plan import METHODS
from tests.verification.cli.test_cli import Capture, refused
from verification.cli import main, solve, solve_table
from verification.cli.plot import hertz_of

SCENE = """
load = 5.0
side = 1e-3
sliding_direction = 0.5
[upper.material]
E = 200e9
nu = 0.3
[[upper.surface]]
kind = "sphere"
radius = 0.05
[lower.material]
E = 3e9
nu = 0.38
[friction]
tau = 0.3e6
beta = 0.1
"""


@pytest.fixture
def scene(tmp_path: Path) -> str:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return str(path)


def test_help_names_the_shipped_scenes() -> None:
    named = re.search(r"Shipped scenes: (.*)\.", solve.EPILOG)
    assert named is not None
    assert tuple(named[1].split(", ")) == refimpl.shipped_scenes()


def test_the_methods_are_those_of_the_solver() -> None:
    assert set(solve.METHODS) == set(METHODS)
    assert set(solve.ACCURATE) == set(QUANTITIES)


def test_an_accuracy_is_met_by_the_error_bar_that_is_shown(scene: str, capsys: Capture) -> None:
    assert main(["solve", scene, "--accuracy", "0.05"]) == 0
    bar = re.search(r"friction coefficient mu +(\S+) +\+- (\S+)", capsys.readouterr().out)
    assert bar is not None
    assert 0 < float(bar[2]) <= 0.055 * float(bar[1])  # the table rounds the bar to one digit


@pytest.mark.parametrize("terminal", [True, False])
def test_progress_is_for_terminals(
    terminal: bool, scene: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    assert main(["solve", scene, "--grid", "16"]) == 0
    shown = capsys.readouterr().err
    assert ("16 x 16 elements, 1 transforms" in shown) is terminal
    assert shown.endswith("\r\x1b[K") is terminal
    assert bool(shown) is terminal


def test_tables_fit_the_terminal(scene: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.chdir(Path(scene).parent)
    assert main(["solve", "scene.toml", "--grid", "16", "--budget"]) == 0
    assert main(["solve", "scene.toml", "--accuracy", "0.01", "--explain"]) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) <= 100


def test_an_error_bar_is_the_sum_of_its_parts(scene: str) -> None:
    solution = refimpl.solve(refimpl.read_scene(scene), grid=8)
    parts = {"approach": {"iteration": 1e-9, "discretisation": 2e-9}}
    bare = dataclasses.replace(solution, uncertainty=parts)
    assert solve_table.error_bar(bare, "approach") == pytest.approx(3e-9)
    assert solve_table.error_bar(bare, "contact_area") == 0


def test_what_nothing_bounds_says_so(scene: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    solution = refimpl.solve(refimpl.read_scene(scene), grid=8)
    parts = {"max_pressure": {"discretisation": math.inf}, "approach": {"discretisation": 2e-9}}
    monkeypatch.setattr(refimpl, "solve", lambda *_, **__: dataclasses.replace(solution, uncertainty=parts))
    assert main(["solve", scene, "--grid", "8"]) == 0
    assert re.search(r"p_max +\S+ +unbounded \(not usable\) +MPa", capsys.readouterr().out)
    assert main(["solve", scene, "--grid", "8", "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["uncertainty"]["max_pressure"] == {"discretisation": None}


UNUSABLE = {"friction_coefficient": 0.2, "max_pressure": 3e13}  # bars found with mu 0.1 and p_max 0.2 GPa


@pytest.mark.parametrize(
    ("bars", "named", "strict"),
    [
        ({}, [], 0),
        (UNUSABLE, ["friction_coefficient", "max_pressure"], 1),
        ({"binormal_force": 0.01}, [], 0),  # Q is zero by symmetry, F about 0.5 N
        ({"binormal_force": 10.0}, ["binormal_force"], 1),
    ],
)
def test_a_bar_above_half_of_the_value_is_a_verdict(
    bars: dict[str, float],
    named: list[str],
    strict: int,
    scene: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    """Once `0.112913 +- 0.2` and `222802 +- 3e+07 MPa`, with exit status 0 and without a word."""
    solution = refimpl.solve(refimpl.read_scene(scene), grid=8)
    parts = {name: {"discretisation": bar} for name, bar in bars.items()}
    monkeypatch.setattr(refimpl, "solve", lambda *_, **__: dataclasses.replace(solution, uncertainty=parts))
    assert main(["solve", scene, "--grid", "8", "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["not_usable"] == named
    assert main(["solve", scene, "--grid", "8", "--strict"]) == strict
    printed = capsys.readouterr().out
    assert printed.count("(not usable)") == len(named)
    if bars == UNUSABLE:
        assert re.search(r"mu +0\.\d\d +\+- 0\.2 \(not usable\)", printed)
        assert re.search(r"p_max +\d\d?0* +\+- 3e\+07 \(not usable\) +MPa", printed)


@pytest.mark.parametrize("finished", [True, False])
def test_an_interrupt_shows_the_last_finished_grid(
    finished: bool, scene: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture, tmp_path: Path
) -> None:
    """Once a refinement of ten minutes printed nothing; the JSON file of an interrupted solve is not made."""
    solution = refimpl.solve(refimpl.read_scene(scene), grid=8)

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt(*([solution] if finished else []))

    monkeypatch.setattr(refimpl, "solve", interrupted)
    assert main(["solve", scene, "--accuracy", "0.01", "--json", str(tmp_path / "s.json")]) == 130
    printed = capsys.readouterr().out
    assert printed.startswith("interrupted; the last finished grid:") is finished
    assert ("8 x 8 elements" in printed) is finished
    assert not (tmp_path / "s.json").exists()


def test_a_frictionless_scene_is_usable(capsys: Capture) -> None:
    assert main(["solve", "hertz", "--grid", "32", "--strict"]) == 0
    assert "not usable" not in capsys.readouterr().out


def test_explain_refuses_strict(scene: str, capsys: Capture) -> None:
    assert main(["solve", scene, "--explain", "--strict"]) == 2
    assert "--strict" in capsys.readouterr().err


def test_json_has_the_solutions_numbers(scene: str, capsys: Capture) -> None:
    assert main(["solve", scene, "--grid", "48", "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    solution = refimpl.solve(refimpl.read_scene(scene), grid=48)
    for attribute, *_ in solve_table.QUANTITIES:
        assert found[attribute] == getattr(solution, attribute)
    assert found["status"] == "converged"
    assert found["certificate"]["gap"] <= 1e-8
    assert {"plan", "warnings", "cost", "uncertainty", "provenance"} <= set(found)


def test_the_table_names_what_was_found(scene: str, capsys: Capture) -> None:
    assert main(["solve", scene, "--grid", "48", "--no-oblique"]) == 0
    printed = capsys.readouterr()
    solution = refimpl.solve(refimpl.read_scene(scene), grid=48, oblique=False)
    rows = {
        r"friction coefficient mu +(\S+)": solution.friction_coefficient,
        r"contact area A +(\S+) .*mm\^2": solution.contact_area / 1e-3**2,
        r"maximum pressure p_max +(\S+) .*MPa": solution.max_pressure / 1e6,
        r"approach +(\S+) .*um": solution.approach / 1e-6,
        r"friction force F +(\S+) .*N": solution.friction_force,
    }
    for pattern, value in rows.items():
        row = re.search(pattern, printed.out)
        assert row is not None, pattern
        last_digit = 10.0 ** -len(row[1].partition(".")[2])
        assert abs(float(row[1]) - value) <= 0.5001 * last_digit
        assert last_digit <= 0.1 * abs(value), "two digits at least"
    for text in ("48 x 48", "CONVERGED", "A, perimeter-corrected", "p_max", "approach", "penetration"):
        assert text in printed.out
    assert "slope terms" in printed.out.partition("not modelled")[2]
    assert printed.err == ""


def test_help_says_that_an_alternating_contact_edge_is_a_success(capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["solve", "--help"])
    told = "exit status: 0 CONVERGED, or CYCLED: converged, with an alternating contact edge"
    assert told in capsys.readouterr().out


@pytest.mark.parametrize(
    ("status", "exit_status"),
    [
        (refimpl.Status.CONVERGED, 0),
        (refimpl.Status.CYCLED, 0),
        (refimpl.Status.STAGNATED, 1),
        (refimpl.Status.ITERATION_LIMIT, 1),
        (refimpl.Status.NO_CONTACT, 1),
    ],
)
def test_exit_status(
    status: refimpl.Status, exit_status: int, scene: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    ended = dataclasses.replace(refimpl.solve(refimpl.read_scene(scene), grid=8), status=status)
    monkeypatch.setattr(refimpl, "solve", lambda *_, **__: ended)
    assert main(["solve", scene]) == exit_status
    printed = capsys.readouterr().out
    assert f"status: {status.name}" in printed
    assert ("--" in printed.partition("friction coefficient")[0]) is (exit_status == 1)  # what to do next


def test_without_contact_mu_is_not_a_number_in_words(scene: str, tmp_path: Path, capsys: Capture) -> None:
    files = ["--json", str(tmp_path / "s.json"), "--plot", str(tmp_path / "s.png")]
    assert main(["solve", scene, "--grid", "8", "--approach", "0", *files]) == 1
    assert re.search(r"friction coefficient mu +n/a", capsys.readouterr().out)
    assert json.loads((tmp_path / "s.json").read_text())["friction_coefficient"] is None


@pytest.mark.parametrize("suffix", [".vtk", ".vtu"])
def test_vtk_holds_both_surfaces_and_the_whole_load(scene: str, suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"s{suffix}"
    assert main(["solve", scene, "--grid", "32", "--vtk", str(path), "--no-oblique"]) == 0
    mesh = meshio.read(path)
    fields = mesh.point_data
    assert set(fields) == {"pressure", "traction", "gap", "height", "body"}
    assert len(mesh.points) == 2 * 32**2
    assert len(mesh.cells_dict["quad"]) == 2 * 31**2
    lower, upper = mesh.points[fields["body"] == 0], mesh.points[fields["body"] == 1]
    np.testing.assert_array_equal(lower[:, :2], upper[:, :2])
    assert lower[0, 0] == pytest.approx(0.5e-3 / 32)
    # Without obliqueness N is the plain sum of the pressures, and balances the load to rounding.
    force = fields["pressure"][fields["body"] == 0].sum() * (1e-3 / 32) ** 2
    assert force == pytest.approx(5.0, rel=1e-12)
    # Each square joins four neighbours of one sheet: its corners span one spacing along x and along y.
    corners = mesh.cells_dict["quad"]
    assert np.ptp(fields["body"][corners], axis=1).max() == 0
    assert set(corners.ravel()) == set(range(2 * 32**2))
    np.testing.assert_allclose(np.ptp(mesh.points[corners][..., :2], axis=1), 1e-3 / 32, rtol=1e-9)
    peak = int(np.argmax(fields["pressure"][fields["body"] == 0]))
    touching = fields["pressure"][fields["body"] == 0] > 0
    gap = (upper - lower)[:, 2]
    np.testing.assert_allclose(gap, fields["gap"][fields["body"] == 0], atol=1e-18)
    # In contact the surfaces coincide to the certificate's 1e-8 of an approach of about 2e-5 m.
    assert np.abs(gap[touching]).max() < 1e-12 < gap[~touching].max()
    assert np.abs(lower[peak, :2] - 0.5e-3).max() < 0.1e-3


def test_the_picture_is_a_picture(scene: str, tmp_path: Path) -> None:
    path = tmp_path / "s.png"
    assert main(["solve", scene, "--grid", "32", "--plot", str(path)]) == 0
    with Image.open(path) as image:
        assert min(image.size) > 800
        colours = image.convert("RGB").getcolors(maxcolors=image.width * image.height)
        assert colours is not None
        assert len(colours) > 50


def test_hertz_of_a_ball_in_a_cup_and_of_no_ball() -> None:
    soft, flat = refimpl.Material(E=1e9, nu=0.5), refimpl.Flat()

    def scene(upper: refimpl.Surface, lower: refimpl.Surface, periodic: bool = False) -> refimpl.Scene:
        bodies = refimpl.Body(soft, upper), refimpl.Body(soft, lower)
        return refimpl.Scene(*bodies, refimpl.Friction(), load=1.0, side=1e-3, periodic=periodic)

    ball, cup = refimpl.Sphere(radius=0.1), refimpl.Sphere(radius=0.2)
    found = hertz_of(scene(ball + flat, cup), load=1.0)
    assert found is not None
    assert found.radius == pytest.approx(0.2)  # 1/R = 1/0.1 - 1/0.2: the cup curves the same way
    assert hertz_of(scene(flat, flat), load=1.0) is None
    assert hertz_of(scene(cup, ball), load=1.0) is None
    assert hertz_of(scene(ball, flat, periodic=True), load=1.0) is None


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["no-such-scene"], "table1-smooth"),
        (["hertz", "--grid", "0"], "grid = 0"),
        (["hertz", "--grid", "1000000"], "GB"),
        (["hertz", "--grid", "8", "--method", "exact"], "exact"),
        (["hertz", "--grid", "8", "--tolerance", "-1"], "tolerance"),
        (["hertz", "--grid", "8", "--accuracy", "0.1"], "not allowed with"),
        (["hertz", "--accuracy", "2"], "accuracy"),
        (["hertz", "--grid", "8", "--approach", "nan"], "approach"),
        (["hertz", "--grid", "8", "--quantity", "contact_area"], "--quantity = 'contact_area'"),
        (["hertz", "--quantity", "contact_area"], "--quantity = 'contact_area'"),
        (["hertz", "--grid", "8", "--explain", "--plot", "p.png"], "--plot"),
        (["hertz", "--grid", "8", "--explain", "--vtk", "s.vtu"], "--vtk"),
        (["hertz", "--grid", "8", "--explain", "--budget"], "--budget"),
        (["hertz", "--grid", "8", "--plot", "picture.jpg"], ".png"),
        (["hertz", "--grid", "8", "--vtk", "surfaces.stl"], ".vtu"),
        (["hertz", "--grid", "8", "--vtk", "/no/such/folder/s.vtu"], "/no/such/folder"),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments: list[str], says: str, capsys: Capture) -> None:
    assert says in refused(capsys, "solve", *arguments)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("load = 5.0", "load = -5.0", "load"),
        ("nu = 0.38", "nu = 0.7", "nu"),
        ("E = 3e9", "E = 0.0", "E = 0.0"),
        ("side = 1e-3", "side = 1e-3\nlaod = 3", "laod"),
        ("[friction]", "[friction", "TOML"),
        ('"sphere"', '"cone"', "cone"),
    ],
)
def test_a_bad_scene_is_refused_and_nothing_is_written(
    old: str, new: str, says: str, tmp_path: Path, capsys: Capture
) -> None:
    assert old in SCENE
    path = tmp_path / "bad.toml"
    path.write_text(SCENE.replace(old, new))
    assert says in refused(capsys, "solve", str(path), "--json", str(tmp_path / "s.json"))
    assert [p.name for p in tmp_path.iterdir()] == ["bad.toml"]


@pytest.mark.parametrize("command", ["solve", "tradeoff"])
@pytest.mark.parametrize("alias", ["scene.toml", "link.toml", "./scene.toml", "heights.npy"])
def test_an_output_is_no_input(
    command: str, alias: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    np.save("heights.npy", np.random.default_rng(1).standard_normal((8, 8)) * 1e-9)
    surface = '[[lower.surface]]\nkind = "measured"\npath = "heights.npy"\nunit = "m"\npixel_size = 2e-4\n'
    text = SCENE.replace("[friction]", f"{surface}[friction]")
    Path("scene.toml").write_text(text)
    Path("link.toml").symlink_to("scene.toml")
    before = Path(alias).read_bytes()
    assert "--json" in refused(capsys, command, "scene.toml", "--json", alias)
    assert Path(alias).read_bytes() == before


def test_a_picture_is_no_input(tmp_path: Path, capsys: Capture) -> None:
    for option, name in (("--plot", "s.png"), ("--vtk", "s.vtu")):
        path = tmp_path / name
        path.write_text(SCENE)
        assert option in refused(capsys, "solve", str(path), "--grid", "8", option, str(path))
        assert path.read_text() == SCENE


def test_no_two_outputs_are_one_file(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("sub").mkdir()
    Path("old.vtu").write_text("old")
    Path("link.json").symlink_to("old.vtu")
    Path("hard.json").hardlink_to("old.vtu")
    for first, second in [("a.vtu", "a.vtu"), ("a.vtu", "sub/../a.vtu"), ("a.vtu", str(tmp_path / "a.vtu")),
                          ("old.vtu", "link.json"), ("old.vtu", "hard.json")]:  # fmt: skip
        err = refused(capsys, "solve", "hertz", "--grid", "8", "--vtk", first, "--json", second)
        assert "--vtk" in err
        assert "--json" in err
    assert Path("old.vtu").read_text() == "old"
    assert not Path("a.vtu").exists()
    assert main(["solve", "hertz", "--grid", "8", "--vtk", "old.vtu", "--json", "/dev/null"]) == 0


@pytest.mark.parametrize("option", ["--plot", "--vtk"])
def test_only_text_goes_to_standard_output(option: str, capsys: Capture) -> None:
    assert option in refused(capsys, "solve", "hertz", "--grid", "8", option, "-")


@pytest.mark.parametrize(
    ("words", "included"), [([], True), (["--plastic", "on"], True), (["--plastic", "off"], False)]
)
def test_pressures_end_at_the_hardness(
    words: list[str], included: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, found = tmp_path / "hard.toml", tmp_path / "hard.json"
    path.write_text(SCENE.replace("nu = 0.38", "nu = 0.38\nhardness = 8e6"))
    assert main(["solve", str(path), "--grid", "32", "--json", str(found), *words]) == 0
    table, document = capsys.readouterr().out, json.loads(found.read_text())
    assert ("plastic area" in table) == included
    assert ("at the hardness A is at least" in " ".join(table.split())) == (not included)
    assert (document["plastic_share"] > 0.3) == included
    assert (document["max_pressure"] == 8e6) == included
    assert document["uncertainty"]["plastic_area"]


def test_plastic_is_on_or_off(scene: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["solve", scene, "--plastic", "yes"])
    assert "expected on or off" in capsys.readouterr().err
    assert main(["solve", scene, "--plastic", "on"]) == 2  # no hardness

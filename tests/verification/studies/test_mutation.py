"""The mutation runner: mutants are made, judged in a fork, sampled fairly, and scored."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from reports.studies import exhibit
from verification.framework.files import write_result
from verification.mutation import campaign, mutants, score, session
from verification.mutation.__main__ import main
from verification.mutation.campaign import Fault, read_areas, read_faults
from verification.mutation.exchanges import exchanged
from verification.mutation.mutants import Candidate, mutant, without_statements
from verification.mutation.targets import JUDGES, TARGETS, definitions, near_first

ROOT = Path(__file__).resolve().parents[3]

SUM_OF_SQUARES = '''
def total(values: list[float], scale: float | None = None) -> float:
    """The sum."""
    found = 0.0
    for value in values:
        found += value * value
    print(found)
    if scale is not None:
        found = found * scale
    return found
'''


def test_statements_that_may_go_unmissed() -> None:
    gone = [
        set(SUM_OF_SQUARES.split("\n")) - set(text.split("\n")) for text in without_statements(SUM_OF_SQUARES)
    ]
    assert sorted(line.strip() for (line,) in gone) == [
        "found += value * value",
        "found = found * scale",
        "print(found)",
    ]
    for text in without_statements(SUM_OF_SQUARES):
        compile(text, "mutant", "exec")


def replacing(monkeypatch: pytest.MonkeyPatch, change: tuple[str, str]) -> None:
    """An operator that replaces a text, in cosmic-ray's place."""
    fake = (None, None, lambda name: name, lambda source, operator, occurrence: source.replace(*change))
    monkeypatch.setattr(mutants, "cosmic_ray", lambda: fake)


def test_a_mutant_says_what_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    replacing(monkeypatch, ("value * value", "value + value"))
    made = mutant(Candidate("sum.py", "arithmetic", "Mul_Add", 0), SUM_OF_SQUARES)
    assert made is not None
    assert (made.line, made.before, made.after) == (6, "found += value * value", "found += value + value")


@pytest.mark.parametrize(
    "change",
    [("float | None =", "float & None ="), ("The sum.", "The total."), ("value * value", "value * * value")],
    ids=["annotation", "docstring", "no Python"],
)
def test_what_cannot_matter_is_no_mutant(change: tuple[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    replacing(monkeypatch, change)
    assert mutant(Candidate("sum.py", "arithmetic", "any", 0), SUM_OF_SQUARES) is None


def test_every_beginning_is_a_proportional_sample() -> None:
    everything = [Candidate("m", "a", "o", i) for i in range(300)] + [
        Candidate("m", "b", "o", i) for i in range(60)
    ]
    order = session.in_fair_order(everything, seed=3)
    assert sorted(order, key=str) == sorted(everything, key=str)
    for size in (60, 120, 240):
        shares = Counter(candidate.stratum for candidate in order[:size])
        assert abs(shares["b"] - size / 6) <= 1
    assert order == session.in_fair_order(everything, seed=3)
    assert order != session.in_fair_order(everything, seed=4)


def record(outcome: str, **changes: Any) -> dict[str, Any]:
    base = {"module": TARGETS[0].module, "stratum": "sign", "operator": "o", "line": 1, "seconds": 0.5}
    return base | {"before": "x", "after": "-x", "outcome": outcome} | changes


def test_score_counts_equivalent_ones_neither_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(score, "explanations", lambda: {(TARGETS[0].module, "a", "b"): "the same"})
    records = [record("killed")] * 18 + [record("timeout"), record("survived", before="a", after="b")]
    found = score.summary([*records, record("void")], population=99, seed=1)
    assert (found["score"], found["score_raw"]) == (1.0, 0.95)
    assert (found["tried"], found["void"], found["equivalent"], found["survived"]) == (20, 1, 1, 0)
    assert found["score_lower_bound"] == pytest.approx(0.05 ** (1 / 19))  # all of 19: closed form
    assert score.passes(found)


@pytest.mark.parametrize(
    "records",
    [
        [],
        [record("void")],
        [record("killed")] * 99 + [record("survived")],  # enough, but one is not explained
        [record("killed")] * 9 + [record("survived")],
    ],
    ids=["none", "void", "unexplained", "too few"],
)
def test_what_is_no_pass(records: list[dict[str, Any]]) -> None:
    assert not score.passes(score.summary(records, population=9, seed=1))


def test_an_explanation_needs_words(tmp_path: Path) -> None:
    listed = tmp_path / "explained.toml"
    listed.write_text("[equivalent.m]\n' ' = [['a', 'b']]\n")
    with pytest.raises(ValueError, match="empty"):
        score.explanations(listed)


def test_one_explanation_is_enough(tmp_path: Path) -> None:
    listed = tmp_path / "explained.toml"
    listed.write_text("[equivalent.m]\nc = [['a', 'b']]\nd = [['x', 'b'], ['a', 'b']]\n")
    with pytest.raises(ValueError, match="twice"):
        score.explanations(listed)


def test_explanations_name_lines_that_exist() -> None:
    for module, before, _ in score.explanations():
        text = " ".join((ROOT / module).read_text(encoding="utf-8").split())
        assert before in text, f"{module}: {before}"


def test_targets_exist() -> None:
    for target in (*TARGETS, *JUDGES):
        assert all((ROOT / path).is_file() for path in (target.module, *target.files))


def test_without_cosmic_ray_nothing_passes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "cosmic_ray.ast", None)
    assert main(["--log", str(tmp_path / "log")]) == 2
    assert "cosmic-ray is not installed" in capsys.readouterr().err


JUDGE = """
import json, sys
from pathlib import Path
from verification.mutation.judge import Suite
root = Path(sys.argv[1])
suite = Suite(root, ("test_half.py",))
suite.baseline()
print(json.dumps([suite.verdict("half.py", source, 2)[:2] for source in json.loads(sys.argv[2])]))
"""


def test_verdicts_on_a_small_tree(tmp_path: Path) -> None:
    (tmp_path / "half.py").write_text("def half(x):\n    return x / 2\n")
    test = "from half import half\ndef test_one(): assert half(2) == 1\ndef test_two(): assert half(4) == 2\n"
    (tmp_path / "test_half.py").write_text(test)
    sources = {
        "def half(x):\n    return 0.5 * x\n": ["survived", None],
        "def half(x):\n    return x - 1\n": ["killed", "test_half.py::test_two"],
        "def half(x):\n    while True: pass\n": ["timeout", None],
        "raise ValueError\n": ["killed", "test_half.py"],
    }
    asked = [sys.executable, "-c", JUDGE, str(tmp_path), json.dumps(list(sources))]
    done = subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT)
    assert json.loads(done.stdout) == list(sources.values())
    assert (tmp_path / "half.py").read_text().endswith("x / 2\n")


def test_a_test_that_finds_no_end_is_named(tmp_path: Path) -> None:
    """Long before the limit of the whole trial: here after one of 30 seconds."""
    (tmp_path / "half.py").write_text("def half(x):\n    return x / 2\n")
    (tmp_path / "test_half.py").write_text("from half import half\ndef test_it(): assert half(2) == 1\n")
    script = JUDGE.replace("source, 2)", "source, 30)").replace(
        "suite.baseline()", "from verification.mutation import judge; judge.LONGEST = 1; suite.baseline()"
    )
    asked = [
        sys.executable,
        "-c",
        script,
        str(tmp_path),
        json.dumps(["def half(x):\n    while True: pass\n"]),
    ]
    done = subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT)
    assert json.loads(done.stdout) == [["killed", "test_half.py::test_it"]]


def test_what_the_parent_has_of_the_tree_is_forgotten(tmp_path: Path) -> None:
    """A mutant of the judge's own package, which the parent runs, is seen by the child all the same."""
    for package in ("refimpl", "verification", "verification/framework"):
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").write_text("")
    (tmp_path / "verification/framework/case.py").write_text("ONE = 1\n")
    test = "from verification.framework.case import ONE\ndef test_it(): assert ONE == 1\n"
    (tmp_path / "test_half.py").write_text(test)
    script = JUDGE.replace('"half.py"', '"verification/framework/case.py"')
    asked = [sys.executable, "-c", script, str(tmp_path), json.dumps(["ONE = 1.0\n", "ONE = 2\n"])]
    done = subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT)
    assert json.loads(done.stdout) == [["survived", None], ["killed", "test_half.py::test_it"]]


def test_a_summary_names_what_was_mutated() -> None:
    judge = JUDGES[0]
    found = score.summary([record("killed", module=judge.module)], 9, 2, of="judges", targets=JUDGES)
    assert found["of"] == "judges"
    assert list(found["by_subject"]) == [judge.subject]
    assert exhibit("mutation_judges", {**found, "confidence": 0.95}).title == "Mutants of the judges"


def test_verdicts_are_kept_and_survivors_tried_again_when_tests_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "m.py").write_text("x = 1\n")
    (tmp_path / "t.py").write_text("first\n")
    target = TARGETS[0]._replace(module="m.py", tests=("t.py",))
    chosen = [Candidate("m.py", "number", "o", k) for k in range(3)]
    tried: list[list[int]] = []

    def judged(root: Path, target: Any, open_ones: list[Candidate], stamp: dict[str, str], log: Path) -> Any:
        tried.append([c.occurrence for c in open_ones])
        new = [
            vars(c) | stamp | {"outcome": "survived" if c.occurrence == 1 else "killed"} for c in open_ones
        ]
        with log.open("a") as lines:
            lines.writelines(json.dumps(line) + "\n" for line in new)
        return new

    monkeypatch.setattr(session, "_try", judged)
    log = tmp_path / "log"
    for _ in range(2):
        assert len(session.run(tmp_path, [target], chosen, log)) == 3
    (tmp_path / "t.py").write_text("second\n")
    assert len(session.run(tmp_path, [target], chosen, log)) == 3
    (tmp_path / "m.py").write_text("x = 2\n")
    session.run(tmp_path, [target], chosen, log)
    assert tried == [[0, 1, 2], [1], [0, 1, 2]]


@pytest.mark.parametrize(
    ("operator", "source", "expected"),
    [
        ("ExchangeArguments", "f(a, b, c=1, d=2)", ["f(b, a, c=1, d=2)", "f(a, b, c=2, d=1)"]),
        ("ExchangeArguments", "f(*a, b)", []),
        ("ExchangeColumns", "x, y = [a, b, b]", ["x, y = [b, a, b]"]),
        ("ExchangeKeys", "{'é': 1, 'F': f(2), **g}", ["{'é': f(2), 'F': 1, **g}"]),
        ("ChangeUnit", "2 * 1e-3 + A / 1e6 + 1e6", ["2 * 1.0 + A / 1e6 + 1e6", "2 * 1e-3 + A / 1e9 + 1e6"]),
    ],
)  # fmt: skip
def test_exchanges(operator: str, source: str, expected: list[str]) -> None:
    found = [changed.replace("1000000000.0", "1e9") for changed in exchanged(source, operator)]
    assert sorted(found) == sorted(expected)


def test_every_listed_fault_changes_its_file() -> None:
    """Each stands once in a module of its area and compiles; all lists are spread over the areas."""
    areas = read_areas()
    first, later, third, fourth = (
        read_faults(campaign.TABLE.with_name(f"{name}.toml"))
        for name in ("faults", "later_faults", "third_faults", "fourth_faults")
    )
    for faults in (first, later, third, fourth):
        assert len(faults) >= 100
        assert len({fault.breaks for fault in faults}) == len(faults)
        for fault in faults:
            source = (ROOT / fault.file).read_text(encoding="utf-8")
            compile(fault.applied(source), fault.file, "exec")
            assert any(fault.file.startswith(f"{folder}/") for folder in areas[fault.area]["modules"])
    assert {fault.area for fault in first} == set(areas) - {"identification"}
    for faults in (later, third, fourth):
        assert {fault.area for fault in faults} == set(areas)


CAMPAIGN = """
import json, sys
from pathlib import Path
from verification.mutation.campaign import Fault, run
faults = [Fault("x", "half.py", b, o, n) for b, o, n in json.loads(sys.argv[2])]
areas = {"x": {"modules": ["."], "tests": ["tests"]}}
found = run(faults, areas, Path(sys.argv[1]) / "log", Path(sys.argv[1]), far=True, **json.loads(sys.argv[3]))
print(json.dumps([[record["outcome"], record["test"], record["failing"]] for record in found]))
"""


def test_a_campaign_on_a_small_tree(tmp_path: Path) -> None:
    """A test that fails anyway does not count, and the file is restored; known verdicts are kept."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "half.py").write_text("def half(x):\n    return x / 2\n")
    test = "from half import half\ndef test_broken(): assert False\ndef test_four(): assert half(4) == 2\n"
    (tmp_path / "tests" / "test_half.py").write_text(test)
    faults = [["same", "x / 2", "0.5 * x"], ["wrong", "x / 2", "x / 3"]]
    asked = [sys.executable, "-c", CAMPAIGN, str(tmp_path), json.dumps(faults), "{}"]
    for _ in range(2):
        done = subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT)
        assert json.loads(done.stdout) == [
            ["unnoticed", None, ["tests/test_half.py::test_broken"]],
            ["noticed", "tests/test_half.py::test_four", ["tests/test_half.py::test_broken"]],
        ]
        assert len((tmp_path / "log").read_text().splitlines()) == 2
    assert (tmp_path / "half.py").read_text().endswith("x / 2\n")


def test_a_campaign_goes_on_where_it_ended_with_the_test_that_noticed_before(tmp_path: Path) -> None:
    (tmp_path / "tests").mkdir()
    (tmp_path / "half.py").write_text("def half(x):\n    return x / 2\n")
    test = "from half import half\ndef test_four(): assert half(4) == 2\n"
    for name in ("test_half.py", "test_other.py"):
        (tmp_path / "tests" / name).write_text(test)
    faults = [["third", "x / 2", "x / 3"], ["less", "x / 2", "x - 1"], ["more", "x / 2", "x + 1"]]
    first = [{"breaks": "less", "test": "tests/test_other.py::test_four"}]
    counts = []
    for tries in (1, 2, 0):
        options = json.dumps({"first": first, "tries": tries})
        asked = [sys.executable, "-c", CAMPAIGN, str(tmp_path), json.dumps(faults), options]
        done = subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT)
        counts.append([test for _, test, _ in json.loads(done.stdout)])
    one, other = "tests/test_half.py::test_four", "tests/test_other.py::test_four"
    assert counts == [[one], [one, other, one], [one, other, one]]


def test_first_judgements_of_a_log_and_of_a_result(tmp_path: Path) -> None:
    rows = [
        {"breaks": "a sign", "first": "unnoticed", "outcome": "noticed", "test": "test_a.py::test_b"},
        {"breaks": "a unit", "first": "not judged", "outcome": "noticed", "test": "test_c.py::test_d"},
    ]
    write_result({"list": rows}, tmp_path / "earlier.json")
    assert campaign.first_judgements(tmp_path / "earlier.json") == [{**rows[0], "outcome": "unnoticed"}]
    (tmp_path / "log.jsonl").write_text(json.dumps(rows[1]) + "\n")
    assert campaign.first_judgements(tmp_path / "log.jsonl") == [rows[1]]


def test_a_survivor_has_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign, "explanations", lambda: {("a.py", "x < 1", "x <= 1"): "x is never 1"})
    base = {"area": "x", "file": "a.py", "test": None, "outcome": "unnoticed"}
    records = [{**base, "breaks": f"Lt_{new}, line 3: x < 1 -> x {new} 1"} for new in ("<=", ">")]
    assert [one["reason"] for one in campaign.summary(records)["list"]] == ["x is never 1", None]


def test_a_fault_that_does_not_fit_is_refused() -> None:
    with pytest.raises(ValueError, match="2 times"):
        Fault("x", "a.py", "y", "b", "c").applied("b + b")


def test_a_campaigns_result_by_area() -> None:
    """Four faults, of which two were noticed at first and three now."""

    def outcomes(*several: str) -> list[dict[str, Any]]:
        base = {"file": "a.py", "test": None}
        areas = ("x", "x", "x", "y")
        return [
            {**base, "area": area, "breaks": f"fault {k}", "outcome": outcome}
            for k, (area, outcome) in enumerate(zip(areas, several, strict=True))
        ]

    first = outcomes("noticed", "unnoticed", "unnoticed", "noticed")
    now = outcomes("noticed", "noticed", "unnoticed", "noticed")
    found = campaign.summary(now, first)
    # one-sided at 95 %: 2 of 4 and more with 5 %, so p^4 + 4 p^3 (1 - p) + 6 p^2 (1 - p)^2 = 0.05
    assert found["all"] == {"faults": 4, "judged": 4, "first": 0.5, "first_lower_bound": 0.0976, "now": 0.75}
    assert [(area["area"], area["first"], area["now"]) for area in found["areas"]] == [
        ("x", 0.3333, 0.6667), ("y", 1.0, 1.0)
    ]  # fmt: skip
    ends = [(one["breaks"], one["first"], one["outcome"]) for one in found["list"]]
    assert ends == [("fault 1", "unnoticed", "noticed"), ("fault 2", "unnoticed", "unnoticed")]
    shown = exhibit("faults_by_hand", found)
    assert shown.tables[0].rows[0] == ("all", 4, 4, 50.0, 9.8, 75.0)
    assert shown.tables[1].rows[0] == ("x", "a.py", "fault 1", "unnoticed", "noticed")


def test_tests_that_mention_what_was_changed_come_after_the_mirror(tmp_path: Path) -> None:
    """Of a function that only a private name of one test's file stands for."""
    source = "LIMIT = 3\n\n\nclass Row:\n    def _load(self):\n        return 1\n"
    changed = source.replace("return 1", "return 2")
    assert definitions(source, changed) == {"Row", "load"}
    assert definitions(source, source.replace("3", "4")) == {"LIMIT"}
    texts = {
        "test_a": "import rows",
        "test_rows": "",
        "test_b": "import rows; x._load",
        "test_c": "load; Row; load",
    }
    for name, text in texts.items():
        (tmp_path / f"{name}.py").write_text(text)
    names = definitions(source, changed)
    found = near_first(tmp_path, "rows.py", ["."], far=False, names=names)
    assert found == ("test_rows.py", "test_c.py", "test_b.py", "test_a.py")
    assert near_first(tmp_path, "rows.py", ["."], far=False) == (
        "test_rows.py", "test_a.py", "test_b.py", "test_c.py",
    )  # fmt: skip

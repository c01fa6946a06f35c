"""The chapters of the report: which subjects and studies belong to each, in the order of reading."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reports.evidence import Evidence
from reports.exhibit import Exhibit
from reports.results import Case, by_subject
from reports.studies import exhibit


@dataclass(frozen=True)
class Chapter:
    """A chapter: its anchor and title, an introduction, subjects of cases, and names of study files."""

    anchor: str
    title: str
    introduction: str
    subjects: tuple[str, ...]
    studies: tuple[str, ...] = ()


CHAPTERS = (
    Chapter(
        "code",
        "Code verification",
        "Kernels, operators, surfaces, force sums and solvers against analytic, high-precision and exactly "
        "known answers, with observed orders; and how far the suite itself can be trusted: seeded faults, "
        "mutants, random examples.",
        (
            "kernels",
            "surfaces",
            "manufactured",
            "balance",
            "capped",
            "hertz",
            "reference",
            "sliding",
            "golden",
            "bounds",
        ),
        (
            "fault_matrix",
            "faults_by_hand",
            "mutation",
            "mutation_fresh",
            "mutation_judges",
            "hypothesis",
            "random_order",
        ),
    ),
    Chapter(
        "solvers",
        "Solvers against each other",
        "The dense reference, the production solver, the paper's own scheme and energy minimisers on the "
        "same problems.",
        ("cross-check", "paper", "variational"),
        ("table2",),
    ),
    Chapter(
        "codes",
        "Other codes, and yours",
        "The suite that any contact solver can be run through, its results for published codes, and "
        "tests of the suite with faulty solvers.",
        ("contestant", "contestants"),
        ("cross_code",),
    ),
    Chapter(
        "appendix",
        "Appendix A: influence coefficients on slopes",
        "Strip, wedge and finite elements in the plane, asperities and waves in three dimensions: how wrong "
        "coefficients of a flat half-space are on a slope, for one coefficient and for a whole contact.",
        (
            "appendix-strip",
            "appendix-wedge",
            "appendix-fem",
            "appendix-figures",
            "fem3d",
            "appendix-correction",
            "model-form",
            "appendix-errata",
        ),
    ),
    Chapter(
        "reproduction",
        "Reproduction of the paper",
        "Every figure, table and quantitative sentence, run again; a verdict may refute the paper, and the "
        "case passes when the verdict stands.",
        ("reproduction", "errata", "sweep"),
    ),
    Chapter(
        "speed",
        "Speed for accuracy",
        "What an error costs: error bars and whether they hold, benchmarks beside published codes, prices.",
        ("accuracy", "sensitivity", "tradeoff", "multilevel", "benchmarks"),
        ("benchmarks", "coverage", "coverage_fresh", "tradeoff", "multilevel"),
    ),
    Chapter(
        "extremes",
        "Extremes, and only what a scene requires",
        "Every axis to the point of failure, inputs that are broken on purpose, and terms that are "
        "neglected because they cannot matter.",
        ("extremes", "planning", "validity"),
        ("extremes", "extremes_drawn", "fuzz", "chaos", "planning"),
    ),
)


def subjects_of(chapter: Chapter, evidence: Evidence) -> dict[str, list[Case]]:
    """The chapter's cases by subject, in the chapter's order; only subjects that have any."""
    present = by_subject(list(evidence.cases))
    return {subject: present[subject] for subject in chapter.subjects if subject in present}


def unplaced(evidence: Evidence) -> dict[str, list[Case]]:
    """Cases whose subject no chapter claims: they are shown all the same."""
    claimed = {subject for chapter in CHAPTERS for subject in chapter.subjects}
    present = by_subject(list(evidence.cases))
    return {subject: cases for subject, cases in present.items() if subject not in claimed}


def exhibits_of(chapter: Chapter, evidence: Evidence) -> Sequence[Exhibit]:
    """The chapter's studies that are at hand."""
    return [exhibit(name, evidence.studies[name]) for name in chapter.studies if name in evidence.studies]

"""The chapters of the report after the reproduction: which subjects and studies belong to each, in order."""

from __future__ import annotations

from dataclasses import dataclass

from reports.evidence import Evidence
from reports.exhibit import Exhibit
from reports.results import Case, by_subject
from reports.studies import exhibit


@dataclass(frozen=True)
class Chapter:
    """A chapter: its anchor and title, an introduction, subjects of cases, and names of study files.

    A folded one shows its introduction, and the rest on request and on paper.
    """

    anchor: str
    title: str
    introduction: str
    subjects: tuple[str, ...]
    studies: tuple[str, ...] = ()

    @property
    def body(self) -> bool:
        """True for what a reader needs beside the claims; the other chapters stand with every check."""
        return self.anchor in ("validation", "limits")

    @property
    def folded(self) -> bool:
        """True for appendices of the report."""
        return self.title.startswith("Appendix I")


REPRODUCED = ("reproduction", "errata")
"""Subjects whose cases the chapter on the paper's figures and tables shows."""

CHAPTERS = (
    Chapter(
        "validation",
        "Validation",
        "Predictions beside published measurements. What was searched, found, and not usable: "
        "docs/experiments.md.",
        ("validation",),
        ("experiments",),
    ),
    Chapter(
        "code",
        "Code and solution verification",
        "Each part of the code is compared with an answer that shares no code with it: kernels with 50-digit "
        "values, surfaces with Eq. (9), solvers with exact solutions, manufactured states and each other. "
        "Orders of convergence are fitted over at least four grids.",
        ("kernels", "surfaces", "manufactured", "hertz", "reference", "balance", "sliding", "golden",
         "bounds", "cross-check", "paper", "variational", "rectangles"),
    ),
    Chapter(
        "appendix",
        "Appendix A: influence coefficients on slopes",
        "Error of coefficients of a flat half-space on a slope: strip and wedge theory, finite elements in "
        "the plane and in three dimensions, for single coefficients and for whole contacts.",
        ("appendix-strip", "appendix-wedge", "appendix-fem", "appendix-figures", "fem3d",
         "appendix-correction", "model-form", "appendix-errata"),
    ),
    Chapter(
        "error-bars",
        "Error bars",
        "Numerical uncertainty of single solves: coverage of the error bars on random scenes against far "
        "finer grids, sensitivities, and budgets after V&V 20. Identification of tau and beta from measured "
        "friction: coverage of its intervals, and effects of wrong input.",
        ("accuracy", "sensitivity", "identification"),
        ("coverage_corrected",),
    ),
    Chapter(
        "yield",
        "Pressures limited by the hardness",
        "Contact beyond yield: pressures between 0 and the hardness of the softer body.",
        ("capped",),
    ),
    Chapter(
        "limits",
        "Limits",
        "Limits of validity of the model and of this implementation, and terms that a solve may neglect.",
        ("planning",),
    ),
    Chapter(
        "trust",
        "Appendix I: quality of the test suite",
        "Random examples and extreme inputs: how far the checks can be trusted.",
        ("extremes",),
        ("hypothesis", "extremes"),
    ),
    Chapter(
        "codes",
        "Appendix II: other codes, and yours",
        "The suite that any contact solver can be run through, its results for published codes, and tests of "
        "the suite with faulty solvers.",
        ("solver", "solver_suite"),
        ("cross_code",),
    ),
    Chapter(
        "costs",
        "Appendix III: costs",
        "Seconds beside published codes at one recomputed error, and the cost of an accuracy.",
        ("benchmarks",),
        ("benchmarks", "accuracy_costs"),
    ),
)  # fmt: skip


def subjects_of(chapter: Chapter, evidence: Evidence) -> dict[str, list[Case]]:
    """Return the chapter's cases by subject, in the chapter's order; only subjects that have any."""
    present = by_subject(evidence.cases)
    return {subject: present[subject] for subject in chapter.subjects if subject in present}


def all_chapters(evidence: Evidence) -> list[Chapter]:
    """Return the chapters, and one of the subjects that no chapter claims before the last main one."""
    claimed = {subject for chapter in CHAPTERS for subject in chapter.subjects} | set(REPRODUCED)
    left = tuple(s for s in by_subject(evidence.cases) if s not in claimed)
    main = [chapter for chapter in CHAPTERS if not chapter.folded]
    back = [chapter for chapter in CHAPTERS if chapter.folded]
    further = [Chapter("further", "Further checks", "", left)] if left else []
    return [*main[:-1], *further, *main[-1:], *back]


def exhibits_of(chapter: Chapter, evidence: Evidence) -> list[Exhibit]:
    """Return the exhibits of the chapter's studies whose result files are there."""
    return [exhibit(name, evidence.studies[name]) for name in chapter.studies if name in evidence.studies]

"""Contact solvers of any origin, run through one suite: bring your own.

`protocol` defines the input and output of a solver under test; `asking` accepts no other output. `checks`
holds the suite's cases, `beds` problems whose pressures are chosen beforehand, `referee` the judge. A program
in any language takes part by `command`; `broken` holds solvers that must not pass, `wrong` their parts.
"""

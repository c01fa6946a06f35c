"""Contact solvers of any origin, run through one suite: bring your own.

`protocol` defines the input and output of a solver under test, `checks` the suite's cases, `pin_arrays`
problems whose pressures are chosen beforehand, `reference_solution` what answers are judged by. A program in
any language takes part by `command`; `faulty_solvers` holds solvers that must not pass.
"""

"""Contact solvers of any origin, run through one suite: bring your own.

`protocol` says what a contestant is given and must return, `problems` and the `suite_*` modules hold the
suite, `command` lets a program in any language take part, `broken` holds solvers that must not pass.
"""

"""Speed beside the published contact solvers: the same problem, the same recomputed error, in turns.

`problems` states the contacts, `codes` the solvers, `timed` one solve in a process of its own, `rounds` the
search for tolerances and the turns, `summary` the table. ``python -m verification.benchmarks --grids
128 256 512 --json FILE`` measures what is installed and appends a run to the record in FILE.
"""

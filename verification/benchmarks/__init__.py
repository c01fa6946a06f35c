"""Speed beside the published contact solvers: the same problem, the same recomputed error, in turns.

``python -m verification.benchmarks --grids 128,256,512 --json FILE`` measures what is installed and appends a
run to the record in FILE.
"""

"""Mutation testing of the numerics, and of what judges them: small faults that some test must notice.

The faults are cosmic-ray's operators and removed statements (`mutants`), in a seeded and stratified order
every beginning of which is a fair sample (`session`). Each is judged by its module's own fast tests, in a
forked process (`judge`). Survivors are killed by better tests or explained in ``explained.toml`` (`score`).
No file is changed: the mutated source exists in the judging process only. cosmic-ray's own runner writes it
to the tree and starts an interpreter for every mutant, which takes longer than most of these trials.
"""

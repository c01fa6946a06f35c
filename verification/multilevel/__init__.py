"""Ensemble means at a stated accuracy: multilevel Monte Carlo (Giles 2008, Oper. Res. 56, 607)."""

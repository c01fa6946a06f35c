"""The terms that a scene requires, before it is solved: the contact to expect, the effect of each term."""

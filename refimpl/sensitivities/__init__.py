"""Derivatives of mu, A, p_max and Q by parameters, and the uncertainty budget."""

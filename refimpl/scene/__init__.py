"""Scenes: bodies, materials, TOML files, and the discrete problem made of them."""

"""`rough-friction appendix-a`: the solutions behind the paper's Appendix A."""

from __future__ import annotations

import argparse


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the subcommand."""
    commands.add_parser("appendix-a", help="solutions of Appendix A")

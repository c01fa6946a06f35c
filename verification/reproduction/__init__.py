"""The paper's tables and figures computed again: one module for each, its printed numbers beside ours."""

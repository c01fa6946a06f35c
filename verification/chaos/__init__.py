"""Sweeps whose processes are killed at random, whose stores are copied and linked, whose disks are full."""

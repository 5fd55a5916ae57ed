"""Compiled bounds and decisions for cells of positions and rotations."""

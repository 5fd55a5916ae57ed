"""Compiled code, made from the stages; importing a module of this package loads numba."""

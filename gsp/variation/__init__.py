"""Bounds of rows, joint values and indices over a patch of poses, in compiled code."""

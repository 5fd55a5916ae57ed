"""Vectors, rotations, poses, boxes of poses, the operation ellipsoid."""

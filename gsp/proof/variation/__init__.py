"""How much rows, joint values and indices vary over a patch of poses, in compiled code."""

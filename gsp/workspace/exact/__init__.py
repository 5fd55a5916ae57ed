"""Workspaces of a fixed orientation, in closed form."""

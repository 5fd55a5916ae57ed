"""Boundary curves of workspaces, with the labels of the source."""

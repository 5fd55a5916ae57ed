"""Workspaces: where a design can go, and what stops it."""

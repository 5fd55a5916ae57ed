"""Parametric families of designs from the papers, with their closed forms."""

from gsp.families import nawratil

__all__ = ["nawratil"]

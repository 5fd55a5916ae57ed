"""Parametric families of designs from the papers, with their closed forms."""

from gsp.families import lee, nawratil

__all__ = ["lee", "nawratil"]

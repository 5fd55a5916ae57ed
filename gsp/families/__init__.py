"""Parametric families of designs: hexapods, and those of the papers with their closed forms."""

from gsp.families import lee, nawratil
from gsp.families.circular import hexapod

__all__ = ["hexapod", "lee", "nawratil"]

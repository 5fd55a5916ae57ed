"""Equations that end a curve: a bound that is met, a weight that is zero, a border."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.workspace.boundary.critical import Chart, Extra, Jet, Points


def constraint_event(i: int, side: int) -> Extra:
    """Return the equation: constraint i is at its bound."""

    def extra(points: Points, jet: Jet) -> tuple[Array, Array]:
        rest = np.zeros_like(points.weight)
        row = np.concatenate((jet.gradient[:, i, side], rest), axis=1)
        return jet.excess[:, i, side, None], row[:, None]

    return extra


def weight_event(place: int) -> Extra:
    """Return the equation: one of the weights is zero."""

    def extra(points: Points, jet: Jet) -> tuple[Array, Array]:
        row = np.zeros((len(points.weight), jet.gradient.shape[-1] + points.weight.shape[1]))
        row[:, jet.gradient.shape[-1] + place] = 1.0
        return points.weight[:, place, None], row[:, None]

    return extra


def across(tangent: Array) -> Extra:
    """Return the equation: do not move along the tangent."""

    def extra(points: Points, jet: Jet) -> tuple[Array, Array]:
        return np.zeros((1, 1)), tangent[None, None]

    return extra


def held_still(tangent: Array, chart: Chart) -> Extra:
    """Return `across` the part of a tangent that moves the pose."""
    row = tangent.copy()
    row[chart.freedoms :] = 0.0
    return across(row / np.maximum(np.linalg.norm(row), 1e-300))


def border_event(chart: Chart, face: Array) -> Extra:
    """Return the equation: the position is on a plane n · p = c, given as (*n, c)."""

    def extra(points: Points, jet: Jet) -> tuple[Array, Array]:
        row = np.zeros((len(points.weight), chart.freedoms + points.weight.shape[1]))
        row[:, : len(chart.axes)] = chart.axes @ face[:3]
        gap = (points.position @ face[:3] - face[3]) / chart.bounds.scale
        return gap[:, None], row[:, None]

    return extra

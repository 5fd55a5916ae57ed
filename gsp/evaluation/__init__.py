"""Indices of designs over many poses: settings, backends, blocks, files."""

from gsp.evaluation.evaluations import evaluate

__all__ = ["evaluate"]

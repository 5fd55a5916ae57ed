"""Indices of designs over many poses: settings, backends, blocks, files."""

from gsp.evaluation.evaluate import evaluate

__all__ = ["evaluate"]

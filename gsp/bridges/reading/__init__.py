"""Models and files of other programs as designs."""

from gsp.bridges.reading.models import FORMS, read_model

__all__ = ["FORMS", "read_model"]

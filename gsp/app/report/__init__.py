"""The report of a design: one HTML page."""

from gsp.app.report.page import report

__all__ = ["report"]

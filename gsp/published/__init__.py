"""Printed numbers of the papers, each with a verdict that is recomputed."""

from gsp.published.check import check, summary
from gsp.published.quantities import PAPERS
from gsp.published.record import Record, read_records, record_files

__all__ = ["PAPERS", "Record", "check", "read_records", "record_files", "summary"]

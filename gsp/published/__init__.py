"""Printed numbers of the papers, each with a verdict that is recomputed."""

from gsp.published.check import check, select, summary
from gsp.published.errata import errata
from gsp.published.quantities import PAPERS, quantities_of
from gsp.published.record import Record, read_records, record_files

__all__ = [
    "PAPERS",
    "Record",
    "check",
    "errata",
    "quantities_of",
    "read_records",
    "record_files",
    "select",
    "summary",
]

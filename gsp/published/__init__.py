"""Printed numbers of the papers, each with a verdict that is recomputed."""

from gsp.published.checking import check, select, select_slips, summary
from gsp.published.errata_page import errata
from gsp.published.ledger import Ledger, ledger_files, read_ledger, unaccounted
from gsp.published.quantities import PAPERS, quantities_of
from gsp.published.record import Record, Slip, read_records, read_slips, record_files

__all__ = [
    "PAPERS",
    "Ledger",
    "Record",
    "Slip",
    "check",
    "errata",
    "ledger_files",
    "quantities_of",
    "read_ledger",
    "read_records",
    "read_slips",
    "record_files",
    "select",
    "select_slips",
    "summary",
    "unaccounted",
]

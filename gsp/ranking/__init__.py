"""Comparison of designs in one table, best first."""

from gsp.ranking.comparison import in_unit
from gsp.ranking.order import rank
from gsp.ranking.tables import STATISTICS

__all__ = ["STATISTICS", "in_unit", "rank"]

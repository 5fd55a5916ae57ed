"""Designs side by side in one table, best first."""

from gsp.ranking.order import rank
from gsp.ranking.tables import STATISTICS

__all__ = ["STATISTICS", "rank"]

"""Where designs, poses and indices meet: evaluate() and rank()."""

from gsp.ranking.blocks import BLOCK
from gsp.ranking.evaluation import evaluate
from gsp.ranking.order import rank
from gsp.ranking.settings import Settings
from gsp.ranking.tables import STATISTICS

__all__ = ["BLOCK", "STATISTICS", "Settings", "evaluate", "rank"]

"""Search of the largest |det J|: climbs along its gradient from many random poses."""

from gsp.determinant.search.gradient import log_determinant
from gsp.determinant.search.rounds import always_singular, climbed_from, search, slope_at

__all__ = ["always_singular", "climbed_from", "log_determinant", "search", "slope_at"]

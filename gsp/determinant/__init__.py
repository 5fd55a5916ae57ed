"""The maximum of |det J|, by which the quality index λ is normalised."""

from gsp.determinant.bounds import is_bounded, upper_bound
from gsp.determinant.domain import Neighbourhood, UnboundedDeterminant, default_neighbourhood
from gsp.determinant.maxima import maximum
from gsp.determinant.record import Maximum
from gsp.determinant.reference_maxima import MaximumWarning, mended, outside, reference
from gsp.determinant.search import log_determinant
from gsp.determinant.store import (
    MaximumInProgress,
    MissingStore,
    Store,
    StoreError,
    StoreWarning,
    open_store,
)

__all__ = [
    "Maximum",
    "MaximumInProgress",
    "MaximumWarning",
    "MissingStore",
    "Neighbourhood",
    "Store",
    "StoreError",
    "StoreWarning",
    "UnboundedDeterminant",
    "default_neighbourhood",
    "is_bounded",
    "log_determinant",
    "maximum",
    "mended",
    "open_store",
    "outside",
    "reference",
    "upper_bound",
]

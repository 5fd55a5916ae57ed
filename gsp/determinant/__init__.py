"""The maximum of |det J| that the quality index λ is measured by."""

from gsp.determinant.bounds import upper_bound
from gsp.determinant.domain import UnboundedDeterminant, default_box
from gsp.determinant.gradient import log_determinant
from gsp.determinant.known import MaximumInProgress
from gsp.determinant.maximum import maximum
from gsp.determinant.record import Maximum
from gsp.determinant.store import Store, StoreError, StoreWarning, open_store

__all__ = [
    "Maximum",
    "MaximumInProgress",
    "Store",
    "StoreError",
    "StoreWarning",
    "UnboundedDeterminant",
    "default_box",
    "log_determinant",
    "maximum",
    "open_store",
    "upper_bound",
]

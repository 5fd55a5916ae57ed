"""Known maxima of |det J|: the database, its entries, their use in searches, and files."""

from gsp.determinant.store.database import (
    Store,
    StoreError,
    StoreWarning,
    location,
    open_store,
)
from gsp.determinant.store.exchange import Imported, export_maxima, import_maxima
from gsp.determinant.store.known import MaximumInProgress, carried, offer, through_store

__all__ = [
    "Imported",
    "MaximumInProgress",
    "Store",
    "StoreError",
    "StoreWarning",
    "carried",
    "export_maxima",
    "import_maxima",
    "location",
    "offer",
    "open_store",
    "through_store",
]

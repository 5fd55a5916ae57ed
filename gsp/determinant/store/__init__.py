"""Known maxima of |det J|: the database, its entries, their use in searches, and files."""

from gsp.determinant.store.connection import MissingStore, StoreError, StoreWarning, location
from gsp.determinant.store.database import Store, open_store
from gsp.determinant.store.exchange import Exported, Imported, export_maxima, import_maxima
from gsp.determinant.store.known import MaximumInProgress, carried, offer, through_store
from gsp.determinant.store.validity import checked_entry, damage, remove_damaged

__all__ = [
    "Exported",
    "Imported",
    "MaximumInProgress",
    "MissingStore",
    "Store",
    "StoreError",
    "StoreWarning",
    "carried",
    "checked_entry",
    "damage",
    "export_maxima",
    "import_maxima",
    "location",
    "offer",
    "open_store",
    "remove_damaged",
    "through_store",
]

"""Quantities that `TozKucuk2016` prints, beside joints and Jacobians."""

from gsp.published.quantities.toz_kucuk_2016.counts import QUANTITIES

__all__ = ["QUANTITIES"]

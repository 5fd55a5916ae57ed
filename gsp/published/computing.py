"""The computation of a record: its quantity with its arguments, in the shape of the print."""

from __future__ import annotations

import inspect
from typing import NoReturn

import numpy as np

from gsp.catalogue import design_names
from gsp.errors import FailedComputation, GspError, MalformedFile, expected
from gsp.geometry.vectors import Array
from gsp.published.quantities import quantities_of
from gsp.published.record import Record


def compute(record: Record) -> Array:
    """Return the values of the quantity of a record, in the shape of what is printed.

    Raises
    ------
    MalformedFile
        If the record names a quantity or a keyword that is not known.
    FailedComputation
        If there is no design of the name, the computation ends with an error, or its result has
        another shape than the print.
    """
    quantities = quantities_of(record.paper)
    function = quantities.get(record.quantity)
    if function is None:
        _fail(record, "quantity", "one of " + ", ".join(quantities), record.quantity)
    try:
        inspect.signature(function).bind(**record.arguments)
    except TypeError as error:
        raise MalformedFile(f"{record.origin}, key 'arguments': {error}") from error
    design = record.arguments.get("design", "")
    if design and design not in design_names():
        wanted = expected("design", "a file in catalogue/designs", f"none of the name {design!r}")
        raise FailedComputation(f"{_named(record)}: {wanted}")
    try:
        # What is undefined, as with a damaged design, is NaN and does not agree.
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.asarray(function(**record.arguments), dtype=np.float64)
    except GspError as error:
        raise FailedComputation(f"{_named(record)}: {error}") from error
    except (TypeError, ValueError, AttributeError, LookupError, ArithmeticError) as error:
        # The text of another library does not state what is wrong with a design.
        reason = f"the calculation ends with {type(error).__name__}"
        raise FailedComputation(f"{_named(record)}: {reason}") from error
    if values.shape != record.printed.shape:
        shapes = f"shape {record.printed.shape}, as printed", f"shape {values.shape}"
        raise FailedComputation(f"{_named(record)}: {expected('result', *shapes)}")
    return values


def _named(record: Record) -> str:
    """Return a record and its design as a message names them."""
    # A record that names no design is of that of its paper, if this has one only.
    stem = record.paper.partition("-")[0].lower()
    own = [name for name in design_names() if name.startswith(stem)]
    design = record.arguments.get("design", own[0] if len(own) == 1 else "")
    of = f", design {design!r}" if design else ""
    return f"{record.origin} ({record.paper}, {record.place}, {record.quantity}{of})"


def _fail(record: Record, key: str, wanted: str, got: str) -> NoReturn:
    raise MalformedFile(f"{record.origin}, key {key!r}: " + expected("value", wanted, got))

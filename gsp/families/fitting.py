"""A check, for closed forms, that the shapes of the arguments broadcast."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from gsp.errors import GspError, InvalidInput, expected

P = ParamSpec("P")
R = TypeVar("R")


def fitting(function: Callable[P, R]) -> Callable[P, R]:
    """Return a function that raises InvalidInput where its arrays do not broadcast together."""

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return function(*args, **kwargs)
        except GspError:
            raise
        except ValueError as error:
            wanted = "shapes that broadcast together"
            raise InvalidInput(expected(function.__name__, wanted, str(error))) from error

    return checked

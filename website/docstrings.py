"""How docstrings are prepared for the reference: an extension of griffe."""

from __future__ import annotations

from typing import Any

import griffe

from website.reference import source_first


class Sources(griffe.Extension):
    """Move the source of a formula above the sections of its docstring."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Change the docstring of one object."""
        if obj.docstring:
            obj.docstring.value = source_first(obj.docstring.value)

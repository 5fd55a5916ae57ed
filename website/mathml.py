"""Formulas between dollar signs become MathML, which browsers draw without a script."""

from __future__ import annotations

import re

FORMULA = re.compile(r"(?<![\\$\w])\$(?!\s)([^$\n]+?)(?<!\s)\$(?![\w$])")
CODE = re.compile(r"(^```.*?^```$|`[^`\n]+`)", re.DOTALL | re.MULTILINE)


def with_mathml(markdown: str) -> str:
    """Return a text with its formulas as MathML; code is left as it is."""
    parts = CODE.split(markdown)
    parts[::2] = [FORMULA.sub(lambda match: mathml(match[1]), part) for part in parts[::2]]
    return "".join(parts)


def mathml(formula: str) -> str:
    """Return one formula of LaTeX as MathML."""
    from latex2mathml.converter import convert

    return convert(formula)

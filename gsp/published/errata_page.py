"""The page of errata, written from the records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from gsp import arguments
from gsp.published.record import Record, Slip, Texts

HEAD = """\
# Errata

Misprints in the papers: numbers and formulas that do not agree with their own definitions. This
page is written from the records in `indices/published/`, and `gsp check` recomputes each of them.
After a change of the records, `gsp check --errata docs/errata.md --force` writes it again. The
keys of the papers are those of [references.md](references.md). For a statement without a number,
the page gives the number that it implies and the number that is computed. After the misprints of
each paper there are slips of the text on which no number depends; nothing is recomputed for them.
"""


@arguments.validated(records=arguments.many(Record), slips=arguments.many(Slip))
def errata(records: Iterable[Record], slips: Iterable[Slip] = ()) -> str:
    """Return the page as Markdown: misprints, slips and readings of each paper.

    Parameters
    ----------
    records : sequence of Record
    slips : sequence of Slip, optional

    Returns
    -------
    str
        Readings are interpretations under which a statement is reproduced.

    Raises
    ------
    InvalidInput
        On items that are not records or slips.

    Examples
    --------
    >>> from gsp.published import read_records, record_files
    >>> errata(read_records(record_files()[0])).splitlines()[0]
    '# Errata'
    """
    by_paper: dict[str, list[Record]] = {}
    for record in records:
        by_paper.setdefault(record.paper, []).append(record)
    given, parts = tuple(slips), [HEAD]
    for paper in sorted(by_paper):
        parts += _paper(paper, by_paper[paper], [slip for slip in given if slip.paper == paper])
    return "\n".join(parts)


def _paper(paper: str, records: list[Record], slips: list[Slip]) -> Iterator[str]:
    wrong = [record for record in records if record.verdict != "reproduced"]
    readings = [r for r in records if r.verdict == "reproduced" and r.proof.startswith("Reading:")]
    if not wrong and not readings and not slips:
        return
    yield f"## {paper}\n"
    for record in wrong:
        yield from _misprint(record)
    if slips:
        yield "### Slips\n"
        lines = (f"- {s.place}: “{s.text}” should be “{s.correct}”. {s.proof}" for s in slips)
        yield "\n".join(lines) + "\n"
    if readings:
        yield "### Readings\n\nStatements that are reproduced under the interpretation given.\n"
        lines = (f"- {r.place}: {r.proof.removeprefix('Reading:').strip()}" for r in readings)
        yield "\n".join(dict.fromkeys(lines)) + "\n"


def _misprint(record: Record) -> Iterator[str]:
    yield f"### {record.place}\n"
    if record.text:
        yield f"Printed: {record.text}\n"
        if record.correct is not None:
            yield f"Implied ({record.quantity.replace('_', ' ')}):{_value(record.printed)}"
    else:
        unit = f" {record.unit}" if record.unit else ""
        yield f"Printed ({record.quantity.replace('_', ' ')}):{_value(record.printed, unit)}"
    if record.correct is not None:
        word = "Computed" if record.text else "Correct"
        yield f"{word}:{_value(record.correct)}"
    mark = "Unreadable" if record.verdict == "unreadable" else "Why"
    yield f"{mark}: {record.proof}\n"


def _value(texts: Texts, unit: str = "") -> str:
    given = [str(text) for text in texts.flat if text]
    if len(given) == 1:
        return f" `{given[0]}`{unit}\n"
    rows = texts if texts.ndim == 2 else texts[None]
    width = max(len(text) for text in given)
    lines = ["  ".join((str(t) or "·").rjust(width) for t in row).rstrip() for row in rows]
    lines = [line for line in lines if line.strip(" ·")]
    return "\n\n```text\n" + "\n".join(lines) + "\n```\n"

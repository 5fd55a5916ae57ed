"""Parts of a report about its task: what holds at single poses, what is wanted, and the places."""

from __future__ import annotations

from html import escape

import numpy as np

from gsp.app.page.tables import number, table
from gsp.app.report.others import has_strokes, quick
from gsp.app.report.parts import cells, listed, wide
from gsp.app.report.study import Study, attempted
from gsp.app.report.summary import bracket, measured, place_text
from gsp.exploration.demands import FORCE, TORQUE
from gsp.exploration.task import HIGH, Wanted
from gsp.model.units import power_base

# Rows of the table of single poses, those first at which the design cannot be used; and the best
# designs that are listed.
MOST_POSES, MOST_DESIGNS = 40, 5


def at_each(study: Study) -> str:
    """Return what holds at each of the single poses of a task."""
    within, unusable, unit = study.within, study.unusable, study.state.design.unit
    bad = unusable != ""
    if within is not None:
        bad = bad | ~within.ok
    shown = np.argsort(~bad, kind="stable")[:MOST_POSES]
    rows = [
        (
            str(i + 1),
            escape(place_text(study.poses[i], unit, study.state.size)),
            "none given" if within is None else escape(study.violation(i)) or "satisfied",
            escape(str(unusable[i])) or "regular",
        )
        for i in sorted(shown.tolist())
    ]
    text = wide(table(("number", "pose", "limits", "Jacobian"), cells(rows)))
    left = len(bad) - len(rows)
    if left:
        text += (
            f"<p class=note>{len(rows)} of {len(bad)} poses, with those first at which something "
            f"is violated: {int(bad.sum())} in all.</p>"
        )
    note = "Each pose is evaluated by itself; nothing is stated of poses between them."
    return f"{text}<p class=note>{note}</p>"


def task(study: Study) -> str:
    """Return what the task wants, and the place of the design among the others by its score."""
    if study.task is None:
        return "<p>No task was given: <code>--task FILE</code>.</p>"
    title = "<h3>This design and the mechanisms on its anchor lines, by the score of the task</h3>"
    found, why = attempted(lambda: _places(study))
    body = f"<p class=note>They are not compared: {escape(why)}</p>" if found is None else found
    return listed(_wanted(study, study.task.wanted)) + title + body


def _wanted(study: Study, wanted: tuple[Wanted, ...]) -> list[tuple[str, str]]:
    """Return name and value of what the task wants of the design, of poses and forces."""
    row, unit = study.assessed, study.state.design.unit
    shown = [(wish.label, _value(study, wish)) for wish in wanted]
    if "feasible" in row:
        n, share = study.poses.size, float(row["feasible"])
        shown.append(
            ("poses within the limits", f"{round(share * n)} of {n} ({100.0 * share:.4g} %)")
        )
    for column, words, measure in (
        (FORCE, "greatest actuator force", "N"),
        (TORQUE, "greatest actuator torque", f"N {unit}".rstrip()),
    ):
        if column in row:
            shown.append((f"{words} under the loads", measured(float(row[column]), measure, 5)))
    return shown


def _value(study: Study, wish: Wanted) -> str:
    row, value = study.assessed, float(study.assessed[wish.column])
    if wish.of != "volume":
        return number(value, 5)
    base = power_base(study.state.design.unit)
    return f"{bracket(value, float(row[f'{wish.index}_{HIGH}']))} {base and base + '³'}".rstrip()


def _places(study: Study) -> str:
    """Return the table of the first designs and of this one, and what holds for it."""
    ranked, wanted = study.ranked, study.task
    assert wanted is not None
    here = int(np.flatnonzero((ranked["design"] == study.name).to_numpy())[0])
    columns = {wish.column: wish.label for wish in quick(wanted).wanted}
    some = int(ranked["score"].notna().sum())
    rows = [
        (
            escape(str(ranked["design"][i])) + (" (this design)" if i == here else ""),
            f"{ranked['rank'][i]:.0f} of {some}" if i < some else "none",
            number(float(ranked["score"][i]), 4),
            *(number(float(ranked[column][i]), 4) for column in columns),
        )
        for i in sorted({*range(min(MOST_DESIGNS, some)), here})
    ]
    notes = []
    if tuple(quick(wanted).wanted) != tuple(wanted.wanted):
        notes.append(
            "The score of this table takes the worst values at the poses of the task in the place "
            "of proven ones, and leaves volumes out."
        )
    if some < len(ranked):
        none = f"None of the {len(ranked)} designs has a place"
        few = f"{len(ranked) - some} of the {len(ranked)} designs have no place"
        notes.append(
            f"{few if some else none}: no pose of the task is within the limits, or a value is "
            "undefined."
        )
    if has_strokes(study.state.design, wanted):
        notes.append(
            "The strokes are for the actuators of this design. All designs of this table are "
            "compared without strokes, also this one, whose values may differ from those above."
        )
    text = wide(table(("design", "place", "score", *columns.values()), cells(rows)))
    return text + "".join(f"<p class=note>{note}</p>" for note in notes)

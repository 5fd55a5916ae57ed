"""`report`: all sections of the report of a design as one HTML page."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from pathlib import Path

from gsp.app.report import parts, proofs, tasks
from gsp.app.report.study import Study, attempted, study_of
from gsp.app.report.summary import place_text, summary
from gsp.app.state.choices import shortened
from gsp.exploration import Task
from gsp.geometry.pose import Pose
from gsp.installed import check_installed
from gsp.model.design import Design
from gsp.progress import Progress, meter
from gsp.version import __version__

PAGE = Path(__file__).parent / "page.html"
Section = tuple[str, Callable[[Study], str]]
SECTIONS: tuple[Section, ...] = (
    ("Geometry", parts.geometry),
    ("Dimensions", parts.dimensions),
    ("Joints and strokes", parts.joints),
    ("Jacobian", parts.jacobian),
    ("Indices", parts.indices),
    ("Workspace", proofs.workspace),
    ("Proven poses", proofs.certificates),
    ("Distance to singularity", proofs.singularity),
    ("Forces", proofs.statics),
    ("Comparison with the catalogue", proofs.comparison),
    ("Task", tasks.task),
)


def report(
    design: Design,
    pose: Pose | None = None,
    task: Task | None = None,
    *,
    length: float | None = None,
    command: str = "",
    progress: Progress = None,
) -> str:
    """Return the report of a design as an HTML page that needs nothing else.

    The page is the same for the same arguments: nothing in it is random.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (), or None [unit of the design]
        Default: the home pose, else above the base.
    task : Task or None
    length : float or None [unit of the design]
        Characteristic length; default that of the task, of the design, or its size.
    command : str
        What made the report, which it states.
    progress : function (done, total), bool or None
        Called after each section; False: no output; None or True: a progress bar.

    Returns
    -------
    str

    Raises
    ------
    InvalidInput
        If task and design have different units, or the length is not positive.
    MissingSoftware
        Without the extras `app` and `plots`.
    """
    check_installed("nicegui", "the report of a design", "app")
    check_installed("matplotlib", "the report of a design", "plots")
    study = study_of(design, pose, task, length)
    state = study.state
    bodies = []
    with meter(progress, "sections") as tell:
        if task is not None:
            study.assessed  # noqa: B018, a task that does not fit is an error
        tell(0, len(SECTIONS))
        for done, (title, make) in enumerate(SECTIONS, 1):
            bodies.append(_section(study, title, make))
            tell(done, len(SECTIONS))
    words = {
        "title": escape(shortened(design.name or "design")),
        "place": escape(place_text(state.pose, design.unit, state.size)),
        "summary": "".join(f"<p>{escape(line)}</p>" for line in summary(study)),
        "contents": "".join(f'<a href="#{_anchor(t)}">{t}</a>' for t, _ in SECTIONS),
        "made": escape(f"gsp {__version__}" + (f", {command}" if command else "")),
        "sections": "".join(bodies),
    }
    # Texts are put between the pieces of the page: a name may contain what looks like a place.
    pieces = PAGE.read_text(encoding="utf-8").split("@@")
    return "".join(words.get(piece, piece) for piece in pieces)


def _section(study: Study, title: str, make: Callable[[Study], str]) -> str:
    """Return a section, or the reason why a design has none."""
    body, why = attempted(lambda: make(study))
    if body is None:
        body = f"<p class=note>{escape(why)}</p>"
    return f'<section id="{_anchor(title)}"><h2>{title}</h2>{body}</section>'


def _anchor(title: str) -> str:
    return title.lower().replace(" ", "-")

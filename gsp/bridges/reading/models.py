"""Designs from files of other programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from gsp import arguments
from gsp.bridges.reading.formats.mjcf import read_mjcf
from gsp.bridges.reading.formats.sdf import read_sdf
from gsp.bridges.reading.formats.urdf import read_urdf
from gsp.bridges.reading.mechanism.designs import design_of
from gsp.bridges.reading.mechanism.linkages import Linkage
from gsp.bridges.reading.packages import design_of_package
from gsp.checks import check_text
from gsp.errors import GspError, InvalidInput, MalformedFile, MissingSoftware, expected
from gsp.model.design import Design

READERS: Mapping[str, Callable[[Path, str, str], Linkage]] = MappingProxyType(
    {".xml": read_mjcf, ".mjcf": read_mjcf, ".urdf": read_urdf, ".sdf": read_sdf}
)
PACKAGES = (".json", ".yaml", ".yml")
FORMS = (*READERS, *PACKAGES)


@arguments.validated(path=arguments.path, base=arguments.text, platform=arguments.text)
def read_model(
    path: str | PathLike[str],
    *,
    name: str | None = None,
    base: str = "",
    platform: str = "",
) -> Design:
    """Return the design of a model of another program, or of a file of a public package.

    A model is a mechanism whose legs are chains between two bodies. Joints at the ends of a leg are
    balls, two or three turns whose axes meet (S), or a slide and a turn along one line (C). Between
    them is a slide, for CCC legs with a turn. A slide or a turn at the base with two spherical
    joints behind it is a leg driven there, by a slider or a crank. The pose of the file is the home
    pose. Limits of actuated joints are the strokes. Without actuators in the file the slides, or
    the first joints of legs without one behind it, are taken for driven.
    A model that the legs of a design do not describe is refused: joints that hold the platform
    beside the legs, coupled joints, legs of fewer than six independent freedoms.

    Parameters
    ----------
    path : path
        Of a model of MuJoCo (.xml, .mjcf), in URDF (.urdf; its loops are in
        `NAME.urdf.loops.json` beside it, as `export` writes them, or in <gazebo>) or SDF (.sdf), or
        a file (.json, .yaml, .yml) of oKermorgant/cdpr, IRMA-LAB/cdpr_matlab or
        64-B1T/basic_robotics.
    name : str or None
        Of the design; default that in the file.
    base, platform : str
        Names of the bodies, of models only. Default for the base: what is fixed to the world, or
        the root; for the platform: the body to which most chains lead from there. Other mechanisms
        in the file are passed over if one of them is given.

    Returns
    -------
    Design
        In metres. Anchors of lines lie where the joint is, unless the file states where the slide
        counts zero (MJCF, and URDF and SDF with the file that `export` writes beside them). Travels
        and angles of drives at the base count from there, too.

    Raises
    ------
    MalformedFile
        With the file, and line or element and key of the first mistake, or with the joints of the
        leg that is none of the catalogue.
    InvalidInput
        If a body is named for a file of a package.
    MissingSoftware
        If MJCF is read without MuJoCo, or YAML without PyYAML.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import gsp
    >>> design = gsp.catalogue.design("dehaeze-general")
    >>> file = Path(mkdtemp(), "hexapod.urdf")
    >>> _ = gsp.bridges.export(design, design.home, "urdf", file)
    >>> gsp.bridges.read_model(file).legs[0].name
    'D1'
    """
    if name is not None:
        name = check_text("name", name)
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in FORMS:
        wanted = "a model ending in " + ", ".join(FORMS)
        raise MalformedFile(expected(str(file), wanted, suffix or "no suffix"))
    for role, body in (("base", base), ("platform", platform)):
        if body and suffix in PACKAGES:
            wanted = f'"", as {file.name} is a file of a package, which names no bodies'
            raise InvalidInput(expected(role, wanted, body))
    try:
        if suffix in PACKAGES:
            return design_of_package(file, name)
        linkage = READERS[suffix](file, base, platform)
        return design_of(linkage, name, chosen=bool(base or platform))
    except (MalformedFile, MissingSoftware):
        raise
    except GspError as error:
        raise MalformedFile(f"{file}: {error}") from error

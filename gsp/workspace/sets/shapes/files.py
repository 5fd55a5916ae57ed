"""Regions as files: outlines for drawing programs, surfaces for printing, tables of cells."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from gsp.errors import EmptyWorkspace, expected
from gsp.files.tables import FORMATS, write_table
from gsp.files.writing import check_writable, write_file
from gsp.geometry.vectors import Array
from gsp.installed import optional
from gsp.model.units import METRES_PER_UNIT
from gsp.workspace.sets.shapes.drawing import FILL
from gsp.workspace.sets.shapes.polygons import polygons, rings
from gsp.workspace.sets.surfaces.meshes import SAME_VERTEX, mesh
from gsp.workspace.sets.tree.boxes import CONVENTION

# What the header of a DXF file calls the units of length ($INSUNITS).
DXF_UNITS = MappingProxyType(
    {"in": 1, "inch": 1, "ft": 2, "mm": 4, "cm": 5, "m": 6, "um": 13, "µm": 13, "\u03bcm": 13,
     "dm": 14}
)  # fmt: skip
# Directions of .glb files, whose second coordinate points upward: x, z, −y.
GLB_AXES = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
# Widths and heights of a drawing, in pixels where it is not scaled.
PIXELS = 800.0
# How far vertices in the middle of an edge that two cells share are moved apart in files, as a
# share of the way to the middle of their cells: single precision of .stl keeps it.
EDGE_GAP = 1e-3
# Distance of vertices that single precision may make one, as a share of the greatest coordinate.
SINGLE_ROUNDING = 2.0**-22
# Digits of a number of double precision.
SIGNIFICANT_DIGITS = 16

if TYPE_CHECKING:
    import trimesh

Rings = list[tuple[str, Array]]


def check_shape(path: str | PathLike[str], kind: str, *, overwrite: bool = False) -> None:
    """Raise if a region of a kind could not be written to `path`, before any work is done.

    Raises
    ------
    UnwritableOutput
        If the suffix does not suit the kind, the file exists, or the folder cannot be written.
    """
    check_writable(path, overwrite=overwrite, suffixes=suffixes(kind))


def suffixes(kind: str) -> tuple[str, ...]:
    """Return the suffixes of the files that a kind of region can be written to."""
    return (*(FLAT if kind == "plane" else SOLID), *FORMATS)


def write(region: Any, path: str | PathLike[str], *, overwrite: bool = False) -> None:
    """Write a region: see `gsp.workspace.Region.write`."""
    check_shape(path, region.kind, overwrite=overwrite)
    suffix = Path(path).suffix.lower()
    if suffix in FORMATS:
        write_table(region.to_dataframe(), path, _facts(region), overwrite=overwrite)
        return
    if region.empty:
        raise EmptyWorkspace(expected(str(path), "a region with a cell or more", "an empty one"))
    if region.kind != "plane" and not region.volume[0] > 0.0:
        wanted = "a region with a part that is proven inside, as with a finer resolution"
        raise EmptyWorkspace(expected(str(path), wanted, "none"))
    fill = (FLAT if region.kind == "plane" else SOLID)[suffix]
    write_file(path, lambda file: fill(region, file), overwrite=overwrite)


def _facts(region: Any) -> dict[str, Any]:
    facts = {
        "design": region.problem.design.name,
        "unit_of_length": region.problem.design.unit,
        "kind": region.kind,
        "measure": list(region.bracket),
    }
    if region.kind != "orientations":
        return facts
    turns = {"unit_of_angles": "degrees", "unit_of_measure": "rad^3", "convention": CONVENTION}
    return {**facts, **turns, "share_of_all": list(region.share)}


def _rings(region: Any) -> Rings:
    """Return closed lines (m, 2) of what is proven inside and of what is possible."""
    outline = polygons(region)
    layers = (("INSIDE", outline.inside), ("POSSIBLE", outline.possible))
    return [(layer, ring) for layer, shape in layers for ring in rings(shape)]


def _svg(region: Any, file: Path) -> None:
    lines = _rings(region)
    low, high = (f([f(points, axis=0) for _, points in lines], axis=0) for f in (np.min, np.max))
    size = high - low
    margin = 0.02 * size.max()
    view = (low[0] - margin, -high[1] - margin, size[0] + 2 * margin, size[1] + 2 * margin)
    scale = PIXELS / max(view[2:])
    root = ElementTree.Element(
        "svg",
        xmlns="http://www.w3.org/2000/svg",
        width=f"{scale * view[2]:.6g}",
        height=f"{scale * view[3]:.6g}",
        viewBox=" ".join(f"{x:.12g}" for x in view),
    )
    design = region.problem.design
    title = [design.name, f"unit {design.unit}" if design.unit else ""]
    ElementTree.SubElement(root, "title").text = ", ".join(filter(None, title))
    for layer, look in (
        ("POSSIBLE", {"fill": "none", "stroke-dasharray": f"{0.01 * size.max():.3g}"}),
        ("INSIDE", {"fill": FILL, "fill-rule": "evenodd"}),
    ):
        paths = [_path(points) for name, points in lines if name == layer]
        ElementTree.SubElement(
            root,
            "path",
            id=layer.lower(),
            d=" ".join(paths),
            stroke="black",
            attrib={"stroke-width": f"{0.002 * size.max():.3g}", **look},
        )
    ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)


def _path(points: Array) -> str:
    """Return a closed line as an SVG path, whose second coordinate points downward."""
    return "M" + " L".join(f"{x:.12g},{-y:.12g}" for x, y in points[:-1]) + " Z"


def _dxf(region: Any, file: Path) -> None:
    with optional("ezdxf", "a region as .dxf", "shapes"):
        import ezdxf
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = DXF_UNITS.get(region.problem.design.unit, 0)
    for layer, colour in (("INSIDE", 5), ("POSSIBLE", 8)):
        document.layers.add(layer, color=colour)
    for layer, points in _rings(region):
        document.modelspace().add_lwpolyline(
            points[:-1].tolist(), close=True, dxfattribs={"layer": layer}
        )
    document.saveas(file)


def _solid(region: Any, file: Path) -> None:
    if file.suffix.lower() == ".obj":  # a text with a number of decimals
        found = mesh(region, gap=EDGE_GAP)
        digits = SIGNIFICANT_DIGITS - int(np.ceil(np.log10(np.abs(found.vertices).max())))
        found.export(file, digits=max(0, digits))
    else:
        _of_single_precision(region).export(file)


def _of_single_precision(region: Any) -> trimesh.Trimesh:
    """Return a surface that stays closed if its coordinates are rounded to single precision."""
    ends = [region.low, region.high]
    near = SINGLE_ROUNDING * np.abs(ends).max() / np.ptp(ends, axis=(0, 1)).max()
    return mesh(region, max(SAME_VERTEX, float(near)), EDGE_GAP)


def _ply(region: Any, file: Path) -> None:
    """Write a surface with coordinates of double precision."""
    found = mesh(region, gap=EDGE_GAP)
    lines = (
        "ply", "format binary_little_endian 1.0",
        f"element vertex {len(found.vertices)}", *(f"property double {x}" for x in "xyz"),
        f"element face {len(found.faces)}", "property list uchar int vertex_indices",
        "end_header", "",
    )  # fmt: skip
    faces = np.empty(len(found.faces), dtype=[("count", "u1"), ("index", "<i4", 3)])
    faces["count"], faces["index"] = 3, found.faces
    content = (np.asarray(found.vertices, dtype="<f8"), faces)
    file.write_bytes("\n".join(lines).encode("ascii") + b"".join(x.tobytes() for x in content))


def _glb(region: Any, file: Path) -> None:
    """Write a surface whose vertices are in the unit of the design, and a node that turns it.

    The node scales it to metres too, if they are known: the format defines both.
    """
    with optional("trimesh", "the surface of a region", "shapes"):
        import trimesh
    unit = "" if region.kind == "orientations" else region.problem.design.unit
    turn = np.eye(4)
    turn[:3, :3] = METRES_PER_UNIT.get(unit, 1.0) * np.array(GLB_AXES)
    scene = trimesh.Scene()
    scene.add_geometry(_of_single_precision(region), transform=turn)
    scene.export(file, file_type="glb")  # type: ignore[no-untyped-call]


FLAT: MappingProxyType[str, Callable[[Any, Path], None]] = MappingProxyType(
    {".svg": _svg, ".dxf": _dxf}
)
SOLID: MappingProxyType[str, Callable[[Any, Path], None]] = MappingProxyType(
    {".stl": _solid, ".obj": _solid, ".ply": _ply, ".glb": _glb}
)

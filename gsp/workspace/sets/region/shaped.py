"""Tables, pictures, shapes and files of a region."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, expected
from gsp.workspace.sets.codes import INSIDE
from gsp.workspace.sets.region.measured import Measured
from gsp.workspace.sets.tree.boxes import TURNS

if TYPE_CHECKING:
    from os import PathLike

    import pandas as pd
    from matplotlib.axes import Axes
    from trimesh import Trimesh

    from gsp.workspace.sets.shapes.polygons import Polygons


@dataclass(frozen=True, eq=False)
class Shaped(Measured):
    """Proven cells of a set, as tables, pictures and shapes."""

    def to_dataframe(self) -> pd.DataFrame:
        """Return the cells as a table: their coordinates, and "inside" or "undecided".

        Returns
        -------
        pandas.DataFrame
            Columns u_low, u_high, v_low, v_high [unit of the design] of a region in a plane,
            x_low … z_high [unit of the design] in space, roll_low … yaw_high [degrees] of
            orientations, R = Rz(yaw) Ry(pitch) Rx(roll), and status.
        """
        import pandas as pd

        names = {"plane": ("u", "v"), "orientations": TURNS}.get(self.kind, ("x", "y", "z"))
        low, high = self.low, self.high
        if self.kind == "orientations":
            low, high = np.rad2deg(low), np.rad2deg(high)
        columns: dict[str, Any] = {}
        for k, name in enumerate(names):
            columns[f"{name}_low"], columns[f"{name}_high"] = low[:, k], high[:, k]
        columns["status"] = np.where(self.codes == INSIDE, "inside", "undecided")
        return pd.DataFrame(columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the region; return the axes.

        A plane is filled, its outline bold, and what is undecided hatched; in space, and for
        orientations, what is proven inside is drawn: cells, and the proven parts of undecided ones.
        The title has the design, the plane, the orientations, and the measure.

        Parameters
        ----------
        ax : matplotlib Axes or None
            Default a new figure. Axes with a title keep it.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        EmptyWorkspace
            If there is nothing to draw.
        InvalidInput
            If `ax` is not axes of the kind that is needed.
        MissingSoftware
            Without matplotlib.
        """
        from gsp.workspace.sets.shapes.drawing import draw

        return draw(self, ax)

    def polygons(self) -> Polygons:
        """Return the outline of a region in a plane, with its holes.

        Returns
        -------
        Polygons [length]
            `inside`, what is proven inside, and `possible`, what is not proven outside: shapes of
            the package shapely, in coordinates along the two directions of the plane.

        Raises
        ------
        InvalidInput
            For a region that is not in a plane.
        MissingSoftware
            Without shapely.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
        >>> region = gsp.workspace.fixed_orientation(d, plane=plane, resolution=0.5)
        >>> shape = region.polygons().inside
        >>> bool(0.9 < shape.area / region.area[0] < 1.1), len(shape.geoms)
        (True, 2)
        """
        from gsp.workspace.sets.shapes.polygons import polygons

        if self.kind != "plane":
            raise InvalidInput(expected("region", "a region in a plane", self.kind))
        return polygons(self)

    def mesh(self) -> Trimesh:
        """Return the surface of what is proven inside: of cells, and of parts of undecided ones.

        Its volume is the least one of the region, `volume[0]`, to about 1e-8 of it, but for parts
        whose plane is nearly along an axis: `volume` bounds those to a thousandth of their cell,
        so that the surface may enclose more. Of orientations it is the volume among the three
        angles, not among the rotations.

        Returns
        -------
        trimesh.Trimesh [length; of orientations rad]
            In base axes, and closed: each edge has two triangles. Where two parts meet in an edge
            only, each has a vertex of its own there, in files a little apart. It is empty if
            nothing is inside.

        Raises
        ------
        InvalidInput
            For a region in a plane.
        MissingSoftware
            Without trimesh.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=2.0)
        >>> surface = region.mesh()
        >>> surface.is_watertight, bool(abs(surface.volume / region.volume[0] - 1) < 1e-7)
        (True, True)
        """
        from gsp.workspace.sets.surfaces.meshes import mesh

        if self.kind == "plane":
            raise InvalidInput(expected("region", "a region in space", self.kind))
        return mesh(self)

    @arguments.validated(path=arguments.path, overwrite=arguments.flag)
    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the region to a file.

        Parameters
        ----------
        path : path
            In a plane .svg or .dxf: the outlines of what is proven inside and of what is possible,
            in the unit of the design. In space .stl, .obj, .ply or .glb: the surface `mesh`, of
            .obj and .ply in double precision, else in single precision; .glb files are in metres,
            where the unit can be converted, and their second coordinate points upward. For all,
            the cells as a table: .csv, .parquet, .xlsx, .md or .tex.
        overwrite : bool
            Whether a file that exists may be replaced.

        Raises
        ------
        EmptyWorkspace
            If nothing is proven inside, but for tables.
        MissingSoftware
            Without shapely, ezdxf or trimesh: the extra "shapes".
        UnwritableOutput
            If the suffix is unknown, the file exists, or the folder cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=2.0)
        >>> region.write(Path(tempfile.mkdtemp(), "region.stl"))
        """
        from gsp.workspace.sets.shapes.files import write

        write(self, path, overwrite=overwrite)

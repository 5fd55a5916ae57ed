"""`Calibration`: dimensions that were identified, how well, and what was not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gsp.calibration.freedoms import identified, in_words
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.model.design import Design
from gsp.model.dimensions import ANCHORS, Dimensions

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, kw_only=True)
class Calibration(ReadOnly):
    """Result of `gsp.calibrate`, for p coordinates of the dimensions, n joints and k poses.

    Attributes
    ----------
    nominal : Design
    design : Design
        With the dimensions that were found.
    zero_points : (n,) array [unit, rad]
        What is to be added to readings to give joint values.
    poses : Pose of batch shape (k,) [unit]
        Those that were given, or that were found along with the dimensions.
    residuals : (k, n) array [unit, rad]
        What `design` predicts for the readings, less the readings.
    weights : (k, n) array [1]
        How much each reading counted: 1 but for readings that the loss takes for outliers.
    names : tuple of str
        Of the coordinates: "base_x1" … for anchor points, "base_line2a", "base_line2b" for the
        turns of lines, "zero_d1" … for zero points.
    deviations : (p,) array [unit, rad]
        Coordinates that were found, less the nominal ones.
    covariance : (p, p) array [products of the units of the coordinates]
        Of the deviations, in the combinations that are determined. NaN where neither errors are
        given nor more data than coordinates.
    singular_values : (p,) array [1]
        Of the sensitivities of all data, each over its standard error, to the coordinates in sizes
        of the design and in rad; descending. Its reciprocal is the standard error of a combination.
    undetermined : (m, p) array [unit, rad]
        Combinations of coordinates, in sizes of the design and in rad orthonormal, on which no
        datum depends. Along them the dimensions are the nearest to the nominal ones.
    chi_squared : float [1]
        Sum of the squares of all residuals, each over its standard error, times their weights.
    degrees_of_freedom : int
        Number of data less that of the unknowns which they determine.
    converged : bool
        If not, no other attribute is that of a minimum: also what is identified and the covariance
        hold at the place where the search ended only.
    iterations : int
    """

    nominal: Design
    design: Design
    zero_points: Array
    poses: Pose
    residuals: Array
    weights: Array
    names: tuple[str, ...]
    deviations: Array
    covariance: Array
    singular_values: Array
    undetermined: Array
    chi_squared: float
    degrees_of_freedom: int
    converged: bool
    iterations: int
    _dimensions: Dimensions

    @property
    def identified(self) -> Mask:
        """Whether the data determine each coordinate by itself, shape (p,)."""
        return identified(self.undetermined / self._dimensions.sizes)

    @property
    def standard_errors(self) -> Array:
        """Standard errors of the deviations, shape (p,) [unit, rad]; infinite if not identified."""
        return np.where(self.identified, np.sqrt(np.diagonal(self.covariance)), np.inf)

    @property
    def not_identified(self) -> tuple[str, ...]:
        """What the data do not determine, such as "6 motions of the base frame"; () for nothing."""
        scaled = self.undetermined / self._dimensions.sizes
        return in_words(self._dimensions, self.design, scaled)

    def table(self) -> pd.DataFrame:
        """Return one row per coordinate.

        Returns
        -------
        pandas.DataFrame
            Columns name, part, leg (from 1), unit, nominal, value, deviation, standard_error and
            identified. Values of turns of lines and of zero points are their deviations.
        """
        import pandas as pd

        given = self._dimensions
        nominal = np.array([_value(self.nominal, given, i) for i in range(len(given))])
        return pd.DataFrame(
            {
                "name": self.names,
                "part": [one.part for one in given.coordinates],
                "leg": [one.leg + 1 for one in given.coordinates],
                "unit": given.units,
                "nominal": nominal,
                "value": nominal + self.deviations,
                "deviation": self.deviations,
                "standard_error": self.standard_errors,
                "identified": self.identified,
            }
        )


def _value(design: Design, dimensions: Dimensions, i: int) -> float:
    """Return the nominal value of a coordinate: of an anchor point, else 0."""
    one = dimensions.coordinates[i]
    if one.part not in ANCHORS[:2]:
        return 0.0
    axis = "xyz".index(one.name.removesuffix(str(one.leg + 1))[-1])
    return float(getattr(design, one.part)[one.leg, axis])

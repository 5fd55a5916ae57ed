"""Every public door of the core refuses every kind of nonsense, with an error of the library.

No other exception may escape and no nonsense may pass, but for what `FINE` lists.
"""

from types import MappingProxyType

import numpy as np
import pytest

import gsp
from gsp import catalogue, indices
from gsp.errors import GspError
from gsp.model.mechanism import Mechanism, read_mechanism

NONSENSE = MappingProxyType({
    "None": None, "text": "abc", "number as text": "1.5", "complex": 1j, "bool": True,
    "nan": float("nan"), "inf": np.inf, "negative": -1.0, "list": [1.0], "ragged": [[1, 2], [3]],
    "object": object(), "great integer": 10**400, "array": np.array([1.0, 2.0]), "dict": {"a": 1},
    "complex array": np.array([1j, 2, 3]), "texts": ["1", "2", "3"], "bools": [True, False, True],
    "date": np.datetime64("2020-01-01"), "bytes": b"\x00\x01", "set": {1.0, 2.0}, "empty": [],
    "type": gsp.Pose, "function": len, "masked": np.ma.array([1.0, 2, 3], mask=[0, 1, 0]),
    "objects": np.array([None, "a", 3], dtype=object), "nested": [[[[1.0]]]],
})  # fmt: skip

HERE = gsp.Pose([0.1, 0.2, 1.5])
BOX = gsp.PoseBox([0, 0, 1], [0, 0, 0])
DESIGN = catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
POSTURE = DESIGN.at(DESIGN.home)
SPHERE = gsp.Ellipsoid(100.0)
MECHANISM = catalogue.mechanism("D1^3 A1^3")


def design(**changes):
    return DESIGN.replace(**changes)


DOORS = {
    "Pose position": gsp.Pose,
    "Pose rotation": lambda x: gsp.Pose([0, 0, 0], x),
    "from_rpy position": lambda x: gsp.Pose.from_rpy(x, [0, 0, 0]),
    "from_rpy angles": lambda x: gsp.Pose.from_rpy([0, 0, 0], x),
    "from_angles order": lambda x: gsp.Pose.from_angles([0, 0, 0], [0, 0, 0], x),
    "from_quaternion": lambda x: gsp.Pose.from_quaternion([0, 0, 0], x),
    "from_se3": gsp.Pose.from_se3,
    "angles order": HERE.angles,
    "compose": HERE.compose,
    "PoseBox position": lambda x: gsp.PoseBox(x, [0, 0, 0]),
    "PoseBox angles": lambda x: gsp.PoseBox([0, 0, 0], x),
    "PoseBox order": lambda x: gsp.PoseBox([0, 0, 0], [0, 0, 0], order=x),
    "around pose": lambda x: gsp.PoseBox.around(x, np.ones(6)),
    "around widths": lambda x: gsp.PoseBox.around(HERE, x),
    "grid": BOX.grid,
    "sample n": lambda x: BOX.sample(x, rng=0),
    "sample rng": lambda x: BOX.sample(2, rng=x),
    "sample method": lambda x: BOX.sample(2, rng=0, method=x),
    "Ellipsoid axes": gsp.Ellipsoid,
    "Ellipsoid center": lambda x: gsp.Ellipsoid(1, x),
    "Ellipsoid rotation": lambda x: gsp.Ellipsoid(1, rotation=x),
    "legs": lambda x: design(legs=x),
    "leg": lambda x: design(legs=[x] * 5),
    "base_points": lambda x: design(base_points=x),
    "platform_points": lambda x: design(platform_points=x),
    "base_directions": lambda x: design(base_directions=x),
    "platform_directions": lambda x: design(platform_directions=x),
    "strokes": lambda x: design(strokes=x),
    "characteristic_length": lambda x: design(characteristic_length=x),
    "ellipsoid": lambda x: design(ellipsoid=x),
    "home": lambda x: design(home=x),
    "unit": lambda x: design(unit=x),
    "name": lambda x: design(name=x),
    "at": DESIGN.at,
    "scaled": DESIGN.scaled,
    "write": DESIGN.write,
    "read_design": gsp.read_design,
    "homogeneous": POSTURE.homogeneous,
    "weighted": POSTURE.weighted,
    "passive_rates": POSTURE.passive_rates,
    "singular": POSTURE.singular,
    **{
        f"{name} posture": lambda x, name=name: getattr(indices, name)(x, 1.0)
        for name in (
            "condition_number", "minimum_singular_value", "control_number", "manipulability",
            "quality_index",
        )
    },
    "condition_number_ellipsoid posture": lambda x: indices.condition_number_ellipsoid(x, SPHERE),
    **{
        f"{name} length": lambda x, name=name: getattr(indices, name)(POSTURE, x)
        for name in (
            "condition_number", "minimum_singular_value", "control_number", "manipulability",
        )
    },
    "quality_index maximum": lambda x: x is None or indices.quality_index(POSTURE, x),
    "condition_number_ellipsoid": lambda x: indices.condition_number_ellipsoid(POSTURE, x, 1.0),
    "condition_number_ellipsoid length": (
        lambda x: indices.condition_number_ellipsoid(POSTURE, SPHERE, x)
    ),
    "Mechanism": Mechanism,
    "Mechanism.of": Mechanism.of,
    "read_mechanism": read_mechanism,
    "mechanism": catalogue.mechanism,
    "design": catalogue.design,
    "instantiate mechanism": lambda x: catalogue.instantiate(x, DESIGN),
    "instantiate template": lambda x: catalogue.instantiate(MECHANISM, x),
    "evaluate design": lambda x: gsp.evaluate(x, HERE),
    "evaluate pose": lambda x: gsp.evaluate(DESIGN, x),
    "rank designs": lambda x: gsp.rank(x, HERE),
    "rank pose": lambda x: gsp.rank(DESIGN, x),
    "rank by": lambda x: gsp.rank(DESIGN, HERE, by=x),
    **{
        f"{f.__name__} {key}": lambda x, f=f, key=key: f(
            DESIGN, HERE, **{"indices": ["manipulability"], key: x}
        )
        for f in (gsp.evaluate, gsp.rank)
        for key in ("indices", "length", "ellipsoid", "maximum", "workers")
    },
}  # fmt: skip

FINE = {
    "Pose rotation": {"None"}, "Ellipsoid rotation": {"None"}, "strokes": {"None"},
    "characteristic_length": {"None"}, "ellipsoid": {"None"}, "home": {"None"},
    "unit": {"text", "number as text"}, "name": {"text", "number as text"},
    "from_se3": {"empty"}, "Mechanism.of": {"empty"}, "singular": {"None"},
    "manipulability length": {"None"}, "quality_index maximum": {"None"}, "rank by": {"None"},
    **{
        f"{f} {key}": fine
        for f in ("evaluate", "rank")
        for key, fine in {
            "indices": {"None"}, "length": {"None"}, "ellipsoid": {"None"}, "workers": {"None"},
            "maximum": {"None", "list"},
        }.items()
    },
}  # fmt: skip


def refusal(door, value):
    """The error of the library, or None; others escape and fail the test."""
    try:
        door(value)
    except GspError as error:
        return error
    return None


@pytest.mark.parametrize("door", DOORS)
def test_nonsense_is_refused(door, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, value in NONSENSE.items():
        if door == "write" and isinstance(value, str):
            continue  # a file name
        error = refusal(DOORS[door], value)
        fine = name in FINE.get(door, ())
        assert (error is None) == fine, f"{door}: {name} gives {error}"
        if error is not None:
            assert 10 < len(str(error)) < 500
            assert "\n" not in str(error)
    assert list(tmp_path.iterdir()) == []

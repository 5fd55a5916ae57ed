"""Files of certificates, of boxes and of paths."""

from __future__ import annotations

import json
from base64 import b64decode
from collections.abc import Callable
from os import PathLike
from typing import Any, get_args
from zlib import decompress
from zlib import error as ZlibError

import numpy as np

from gsp.checks import plain_text
from gsp.errors import MalformedFile, brief, expected, form_of
from gsp.files.writing import read_text
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.model.design import design_from_toml
from gsp.proof.branching.tree import is_complete
from gsp.proof.certificate import FORMAT, Certificate
from gsp.proof.paths.certificate import PATH_FORMAT, PathCertificate
from gsp.proof.recorded import Status

# What a record that is not a certificate leads to.
MALFORMED = (
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    OverflowError,
    RecursionError,
    ZlibError,
)


def read_certificate(path: str | PathLike[str]) -> Certificate | PathCertificate:
    """Read a certificate that was written. Nothing is checked again: see `verify`.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    Certificate or PathCertificate
        As it was written.

    Raises
    ------
    MalformedFile
        If the file cannot be read, or is not a certificate.
    """
    path = plain_text(path)
    text = read_text(path)
    try:
        record = json.loads(text)
        if not isinstance(record, dict):
            raise MalformedFile(expected(str(path), "a gsp certificate", brief(record)))
        readers: dict[str, Callable[[Any, str], Certificate | PathCertificate]]
        readers = {FORMAT: _of_box, PATH_FORMAT: _of_path}
        if record["format"] not in readers:
            wanted = f"{FORMAT} or {PATH_FORMAT}"
            raise MalformedFile(expected(str(path), wanted, brief(record["format"])))
        if record["status"] not in get_args(Status):
            raise MalformedFile(f"{path}: the status is not that of a certificate")
        if not isinstance(record["reason"], str):
            raise MalformedFile(expected(f"{path}, reason", "a text", brief(record["reason"])))
        boxes = record["n_boxes"]
        if not isinstance(boxes, int) or isinstance(boxes, bool) or boxes < 0:
            raise MalformedFile(expected(f"{path}, n_boxes", "an integer ≥ 0", brief(boxes)))
        return readers[record["format"]](record, str(path))
    except MalformedFile:
        raise
    except MALFORMED as error:
        raise MalformedFile(
            f"{path}: expected a gsp certificate, received {form_of(error)}"
        ) from error


def _of_box(record: dict[str, Any], path: str) -> Certificate:
    box = record["box"]
    pairs = list(zip(box["low"], box["high"], strict=True))
    tree = np.frombuffer(decompress(b64decode(record["tree"])), dtype=np.int8)
    if not is_complete(tree):
        raise MalformedFile(f"{path}: the tree is not that of a certificate")
    return Certificate(
        status=record["status"],
        counterexample=_pose(record["counterexample"]),
        reason=record["reason"],
        bracket=_pose(record["bracket"]),
        points=_points(record["points"], path),
        n_boxes=record["n_boxes"],
        tree=tree,
        claims=record["claims"],
        design=design_from_toml(record["design"], path),
        box=PoseBox(pairs[:3], pairs[3:], order=box["order"]),
    )


def _points(given: Any, path: str) -> Array:
    points = np.array(given, dtype=np.float64)
    if given != [] and (points.ndim != 2 or points.shape[1] != 6):
        raise MalformedFile(expected(f"{path}, points", "lists of six numbers", brief(given)))
    return points.reshape(-1, 6)


def _of_path(record: dict[str, Any], path: str) -> PathCertificate:
    bracket = record["bracket"]
    return PathCertificate(
        status=record["status"],
        reason=record["reason"],
        bracket=None if bracket is None else (float(bracket[0]), float(bracket[1])),
        counterexample=_pose(record["counterexample"]),
        points=tuple(float(x) for x in record["points"]),
        intervals=tuple((float(a), float(b), str(mark)) for a, b, mark in record["intervals"]),
        parts=record["parts"],
        n_boxes=record["n_boxes"],
        claims=dict(record["claims"]),
        path={**record["path"], "times": [float(x) for x in record["path"]["times"]]},
        design=design_from_toml(record["design"], path),
    )


def _pose(record: dict[str, Any] | None) -> Pose | None:
    return None if record is None else Pose(record["position"], record["rotation"])

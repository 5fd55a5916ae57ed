"""The same algorithm in C: the stages printed as C, a driver by hand, compiled by gcc.

It exists for this comparison only.
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import gsp
from gsp.evaluation.backends import flat_design, flat_ellipsoid, length_of
from gsp.evaluation.settings import Settings
from gsp.kernels import stages
from gsp.kernels.problems import RESULTS
from gsp.kernels.trace import Traced, needed

FORMS = {
    "+": "{0} + {1}",
    "-": "{0} - {1}",
    "*": "{0} * {1}",
    "/": "{0} / {1}",
    "<": "{0} < {1}",
    "sqrt": "root({0})",
    "choose": "choose({0}, {1}, {2})",
}
FLAGS = ["-O3", "-march=native", "-ffp-contract=fast", "-fno-math-errno", "-shared", "-fPIC"]
DRIVER = Path(__file__).with_name("driver.c")


def printed_stage(stage: stages.Stage) -> str:
    """Print a stage as a C function on vectors of eight doubles."""
    name = stage.name.replace(" ", "_").lower()
    kinds = [f"double *{a}" for a in stage.arrays] + [f"double {s}" for s in stage.scalars]
    lines = [f"static void {name}({', '.join(kinds)}) {{"]
    if stage.repeat:
        lines += [f"for (int step = 0; step < {stage.repeat}; step++) {{"]
    for node in needed(value for _, _, value in stage.outputs):
        kind = "mask" if node.op == "<" else "vector"
        lines.append(f"const {kind} t{node.number} = {_expression(node)};")
    for array, k, value in stage.outputs:
        lines.append(f"store({array} + {k * stages.LANES}, {_argument(value)});")
    if stage.repeat:
        lines += [f"if (!any({_argument(stage.outputs[-1][2])})) break;", "}"]
    return "\n".join([*lines, "}"])


def _expression(node: Traced) -> str:
    match node.op:
        case "lane":
            return f"load({node.args[0]} + {node.args[1] * stages.LANES})"
        case "uniform":
            return f"spread({node.args[0]}[{node.args[1]}])"
        case "scalar":
            return f"spread({node.args[0]})"
    return FORMS[node.op].format(*map(_argument, node.args))


def _argument(value) -> str:
    return f"t{value.number}" if isinstance(value, Traced) else f"spread({float(value)!r})"


def _table(name: str, group: tuple[stages.Stage, ...], kinds: str) -> str:
    names = ", ".join(stage.name.replace(" ", "_").lower() for stage in group)
    return f"static void (*const {name}[])({kinds}) = {{{names}}};"


def source() -> str:
    """Return the text of the C file."""
    singles = (
        stages.REACH_STAGE, stages.ELLIPSOID_FRAME, stages.HOMOGENEOUS_ROW, stages.ELLIPSOID_ROW,
        stages.SOLVED_ROW, stages.BIDIAGONAL, stages.LAGUERRE, stages.EXTREMES,
    )  # fmt: skip
    groups = (stages.ACTUATORS, stages.PASSIVE, stages.SWEEPS, stages.PIVOTS)
    printed = [printed_stage(s) for s in (*singles, *(s for group in groups for s in group))]
    pointers = "double *, double *, double *"
    tables = [
        _table("actuators", stages.ACTUATORS, pointers + ", double"),
        _table("passive", stages.PASSIVE, pointers + ", double"),
        _table("sweep", stages.SWEEPS, pointers),
        _table("pivot", stages.PIVOTS, pointers + ", double *"),
        f"static const int N_ACTUATORS[] = {{{_numbers(stages.N_ACTUATORS)}}};",
        f"static const int N_PASSIVE[] = {{{_numbers(stages.N_PASSIVE)}}};",
    ]
    text = DRIVER.read_text(encoding="utf-8")
    return text.replace("/* STAGES */", "\n\n".join([*printed, *tables]))


def _numbers(values) -> str:
    return ", ".join(map(str, values))


class Program:
    """The compiled program, loaded; `run` is what `compiled_results` is for the library."""

    def __init__(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        code, library = Path(self.folder.name, "gsp.c"), Path(self.folder.name, "gsp.so")
        code.write_text(source(), encoding="utf-8")
        subprocess.run(["gcc", *FLAGS, "-o", library, code, "-lm"], check=True)
        self.function = ctypes.CDLL(str(library)).evaluate_block
        self.function.restype = None

    def run(self, design: gsp.Design, settings: Settings, pose: gsp.Pose, problems: int):
        """Return the results as an array (5, n)."""
        kinds, geometry = flat_design(design)
        results = np.empty((RESULTS, pose.size))
        arrays = (
            np.ascontiguousarray(pose.position),
            np.ascontiguousarray(pose.rotation),
            kinds,
            geometry,
            flat_ellipsoid(settings.ellipsoid),
            results,
        )
        position, rotation, kind, geo, ell, out = (
            array.ctypes.data_as(ctypes.c_void_p) for array in arrays
        )
        self.function(
            position,
            rotation,
            ctypes.c_long(pose.size),
            kind,
            ctypes.c_long(design.n_legs),
            geo,
            ell,
            ctypes.c_double(length_of(design, settings)),
            ctypes.c_long(problems),
            out,
        )
        return results

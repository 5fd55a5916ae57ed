"""How near the compiled kernel is to what the machine can do: operations over measured peaks."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import gsp
from benchmarks.c_code import FLAGS
from benchmarks.cases import ELLIPSOID, LENGTH, UPS, poses
from benchmarks.timing import Way, in_turn
from gsp.evaluation.backends import compiled_results
from gsp.evaluation.settings import Settings
from gsp.geometry.matrices import whiten
from gsp.kernels.formulas.spectrum import bidiagonal, laguerre, laguerre_start
from gsp.kernels.operations import evaluation
from gsp.kernels.problems import CONTROL_PROBLEM, ELLIPSOID_PROBLEM, HOMOGENEOUS_PROBLEM
from gsp.kernels.stages import LANES, MOST_LAGUERRE_STEPS

# Independent chains of operations, as many as hide the latency of one.
CHAINS = 16
SOURCE = """
typedef double vector __attribute__((vector_size(64)));
#define N %d
double products(long n) {
    vector x[N], a = (vector){} + 0.999999, b = (vector){} + 1e-7;
    for (int i = 0; i < N; i++) x[i] = a * (1.0 + i);
    while (n--) for (int i = 0; i < N; i++) x[i] = x[i] * a + b;
    vector s = x[0];
    for (int i = 1; i < N; i++) s += x[i];
    return s[0] + s[3];
}
double divisions(long n) {
    vector x[N], a = (vector){} + 1.25;
    for (int i = 0; i < N; i++) x[i] = a * (1.0 + i);
    while (n--) for (int i = 0; i < N; i++) x[i] = a / x[i];
    vector s = x[0];
    for (int i = 1; i < N; i++) s += x[i];
    return s[0] + s[3];
}
"""


def peaks(rounds: int = 7) -> tuple[float, float]:
    """Return fused products and sums, two operations each, and divisions per second of one core."""
    with tempfile.TemporaryDirectory() as folder:
        code, library = Path(folder, "peak.c"), Path(folder, "peak.so")
        code.write_text(SOURCE % CHAINS, encoding="utf-8")
        more = ["-funroll-loops", "-mprefer-vector-width=512"]
        subprocess.run(["gcc", *FLAGS, *more, "-o", library, code], check=True)
        loaded = ctypes.CDLL(str(library))
        best = []
        for name, n, each in (("products", 2_000_000, 2), ("divisions", 200_000, 1)):
            function = getattr(loaded, name)
            function.restype, function.argtypes = ctypes.c_double, [ctypes.c_long]
            times = []
            for _ in range(rounds):
                start = time.process_time()
                function(n)
                times.append(time.process_time() - start)
            best.append(n * CHAINS * LANES * each / min(times))
    return best[0], best[1]


def steps(design: gsp.Design, pose: gsp.Pose) -> float:
    """Return Laguerre steps per matrix, as blocks of LANES poses take them, of three problems."""
    posture = design.at(pose)
    weighted = posture.weighted(LENGTH)
    matrices = (
        posture.homogeneous(LENGTH),
        ELLIPSOID.whiten(weighted, pose.rotation),
        whiten(weighted, posture.passive_rates(LENGTH)),
    )
    return float(np.mean([_steps(np.moveaxis(m, 0, -1)) for m in matrices]))


def _steps(matrix: np.ndarray) -> float:
    q, e, _ = bidiagonal([list(row) for row in matrix])
    with np.errstate(all="ignore"):
        q, e, _, high = laguerre_start(q, e)
        low, active = np.zeros_like(high), np.ones_like(high)
        count = np.zeros(high.size // LANES)
        for _ in range(MOST_LAGUERRE_STEPS):
            count += active.reshape(-1, LANES).any(axis=1)
            new_low, below = laguerre(q, e, low, 1.0)
            new_high, above = laguerre(q, e, high, -1.0)
            low, high = np.where(active > 0, new_low, low), np.where(active > 0, new_high, high)
            active = np.where(active > 0, below + above, 0.0)
    return float(count.mean())


def section(rounds: int) -> str:
    """Operations of all indices of a UPS design, and the time of the kernel over measured peaks."""
    pose, settings = poses(100_000), Settings(LENGTH, ELLIPSOID, 1.0)
    problems = HOMOGENEOUS_PROBLEM | ELLIPSOID_PROBLEM | CONTROL_PROBLEM
    per_problem = steps(UPS, pose[:4096])
    count = evaluation(UPS.legs, problems, per_problem)
    kernel = Way(lambda: compiled_results(UPS, settings, pose, problems), pose.size)
    seconds = in_turn({"kernel": kernel}, rounds)["kernel"].min()
    products, divisions = peaks()
    at_peak = (count.sums + count.products) / products
    divided = (count.divisions + count.roots) / divisions
    return (
        f"All indices of a UPS design take {count.sums:,.0f} sums, {count.products:,.0f} products, "
        f"{count.divisions:,.0f} divisions and {count.roots:,.0f} square roots per pose "
        f"({per_problem:.1f} Laguerre steps per problem): {count.total:,.0f} operations in "
        f"{seconds * 1e9:,.0f} ns, {count.total / seconds / 1e9:.1f} Gflop/s. One core does "
        f"{products / 1e9:.0f} Gflop/s in fused products and sums, and {divisions / 1e9:.2f} · 10⁹ "
        f"divisions per second. At these rates sums and products take {at_peak * 1e9:.0f} ns and "
        f"divisions and roots {divided * 1e9:.0f} ns, executed in parallel: the kernel takes "
        f"{seconds / max(at_peak, divided):.1f} times as long as this limit."
    )

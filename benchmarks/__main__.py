"""`make bench`: measure, print, and write the tables of docs/performance.md."""

from __future__ import annotations

import argparse
import platform
import re
import time
from pathlib import Path

import numpy as np

import gsp
from benchmarks import (
    bench_app,
    bench_exploration,
    bench_forward,
    bench_modes,
    bench_proofs,
    bench_sets,
    bench_statics,
    c_code,
    cases,
    limit,
    loops,
    processes,
    stacked,
)
from benchmarks.timing import Way, in_turn, markdown, ratio, rows
from gsp.evaluation.backends import compiled_results
from gsp.evaluation.settings import Settings

PAGE = Path(__file__).parent.parent / "docs" / "performance.md"
HEAD = ("method", "median, ns per pose", "least", "times faster than numpy (least … greatest)")
NUMPY = 'numpy, stacked LAPACK, chunks of 2,048 (`backend="numpy"`)'
OURS = "compiled, one core (`gsp.evaluate`)"


def evaluation(design, pose, names, **more):
    given = {**cases.GIVEN, "workers": 1, "progress": False, **more}
    return Way(lambda: gsp.evaluate(design, pose, names, **given), pose.size)


def ups(rounds: int) -> str:
    """All indices for UPS legs, by each way, single-core CPU time."""
    few, some, many = (cases.poses(n) for n in (100, 4_000, 100_000))
    angles = few.angles()
    program = c_code.Program()
    settings = Settings(cases.LENGTH, cases.ELLIPSOID, 1.0)
    ways = {
        "loop, numpy and scipy per pose": Way(lambda: loops.plain(cases.UPS, few), few.size),
        "loop of a public peer (three indices only)": Way(
            lambda: loops.peer(cases.UPS, few.position, angles), few.size
        ),
        NUMPY: evaluation(cases.UPS, some, cases.INDICES, backend="numpy"),
        "numpy, written for UPS legs only, chunks of 2,000": Way(
            lambda: stacked.stacked(cases.UPS, some), some.size
        ),
        OURS: evaluation(cases.UPS, many, cases.INDICES),
        "compiled, one core, kernel only": Way(
            lambda: compiled_results(cases.UPS, settings, many, 7), many.size
        ),
        "the same algorithm in C, gcc -O3 -march=native, kernel only": Way(
            lambda: program.run(cases.UPS, settings, many, 7), many.size
        ),
    }
    times = in_turn(ways, rounds)
    loop = ratio(times, "loop, numpy and scipy per pose", OURS)
    c = ratio(times, "compiled, one core, kernel only", [*ways][-1])
    return (
        markdown(HEAD, rows(times, NUMPY))
        + f"\n\nTimes faster than the loop: {loop[1]:,.0f} ({loop[0]:,.0f} … {loop[2]:,.0f}). "
        f"Time of the kernel over that of C: {c[1]:.2f} ({c[0]:.2f} … {c[2]:.2f})."
    )


def single_indices(rounds: int) -> str:
    """Each index alone, UPS legs."""
    some, many = cases.poses(4_000), cases.poses(100_000)
    table = []
    for name in cases.INDICES:
        ways = {
            "numpy": evaluation(cases.UPS, some, [name], backend="numpy"),
            "compiled": evaluation(cases.UPS, many, [name]),
        }
        times = in_turn(ways, rounds)
        low, middle, high = ratio(times, "numpy", "compiled")
        nanoseconds = (f"{np.median(times[way]) * 1e9:,.0f}" for way in ways)
        table.append((f"`{name}`", *nanoseconds, f"{middle:.3g} ({low:.3g} … {high:.3g})"))
    return markdown(("index alone", "numpy, ns", "compiled, ns", "ratio"), table)


def mixed(rounds: int) -> str:
    """All indices of every 13th of the 195 mechanisms, in chunks that suit numpy."""
    designs = cases.catalogue()[::13]
    some, many = cases.poses(2_048), cases.poses(16_384)
    ways = {
        NUMPY: Way(
            lambda: [evaluation(d, some, cases.INDICES, backend="numpy").run() for d in designs],
            len(designs) * some.size,
        ),
        OURS: Way(
            lambda: [evaluation(d, many, cases.INDICES).run() for d in designs],
            len(designs) * many.size,
        ),
    }
    return markdown(HEAD, rows(in_turn(ways, rounds), NUMPY))


def cores(rounds: int) -> str:
    """One and two threads, wall time, beside one and two independent processes."""
    pose, designs = cases.poses(1_000_000), cases.catalogue()[::10]
    part = pose[:100_000]
    with processes.independent(pose.size) as at_once:
        return _cores(rounds, pose, designs, part, at_once)


def _cores(rounds, pose, designs, part, at_once) -> str:
    table = []
    for name, one in {
        "independent processes": lambda n: Way(lambda: at_once(n), n * pose.size),
        "`gsp.evaluate`, UPS": lambda n: evaluation(cases.UPS, pose, cases.INDICES, workers=n),
        "`gsp.rank`, mixed": lambda n: Way(
            lambda: gsp.rank(
                designs, part, cases.INDICES, workers=n, progress=False, **cases.GIVEN
            ),
            part.size * len(designs),
        ),
    }.items():
        times = in_turn({str(n): one(n) for n in (1, 2)}, 2 * rounds, time.perf_counter)
        low, middle, high = ratio(times, "1", "2")
        best = times["1"].min() / times["2"].min()
        table.append((name, f"{middle:.2f} ({low:.2f} … {high:.2f})", f"{best:.2f}"))
    return markdown(("job", "two cores over one, wall time", "of the least times"), table)


def latency(rounds: int) -> str:
    """One pose, the Jacobian and an index, CPU time."""
    pose = cases.UPS.home
    fast = gsp.prepare(cases.UPS, "condition_number", length=cases.LENGTH)
    p, r = pose.position, pose.rotation

    def by_posture():
        posture = cases.UPS.at(gsp.Pose(p, r))
        return posture.jacobian, gsp.indices.condition_number(posture, cases.LENGTH)

    def by_numpy():
        arms = cases.UPS.platform_points @ r.T
        d = p + arms - cases.UPS.base_points
        u = d / np.linalg.norm(d, axis=1)[:, None]
        jacobian = np.hstack((u, np.cross(arms, u)))
        return jacobian, np.linalg.cond(jacobian / np.array([1, 1, 1, 95.0, 95.0, 95.0]))

    def repeated(function, n=500):
        return Way(lambda: [function() for _ in range(n)], n)

    ways = {
        "numpy, written for UPS legs": repeated(by_numpy),
        "`design.at(Pose(p, R))`, `.jacobian`, `condition_number`": repeated(by_posture, 100),
        '`gsp.prepare(design, "condition_number")(p, R)`': repeated(lambda: fast(p, r)),
    }
    times = in_turn(ways, rounds)
    head = ("method", "median, µs per pose", "least", "times faster than numpy (least … greatest)")
    table = [
        (name, f"{np.median(t) * 1e6:.1f}", f"{t.min() * 1e6:.1f}", line[3])
        for (name, t), line in zip(times.items(), rows(times, next(iter(ways))), strict=True)
    ]
    return markdown(head, table)


def start() -> str:
    """Time to the first result, after `import gsp`."""
    table = [(n, f"{wall:.2f}", f"{cpu:.2f}") for n, (wall, cpu) in processes.starts().items()]
    return markdown(("compiled code on disk", "wall, s", "CPU, s"), table)


def whole(rounds: int) -> str:
    """Whole processes from start to exit, in turn; files are in the cache of the system."""
    times = {name: [] for name in processes.PROCESSES}
    for _ in range(rounds + 1):  # the first round reads files and writes byte code
        for name, arguments in processes.PROCESSES.items():
            times[name].append(processes.whole(arguments))
    table = []
    for name, runs in times.items():
        wall, cpu = np.array(runs[1:]).T
        table.append((name, f"{np.median(wall):.2f}", f"{wall.min():.2f}", f"{np.median(cpu):.2f}"))
    return markdown(("process", "wall, s", "least", "CPU, s"), table)


def growth(largest: int) -> str:
    """Time and memory from 10³ poses on, one core."""
    table = []
    for exponent in range(3, largest + 1):
        seconds, before, after = processes.run(processes.GROWTH.format(n=10**exponent))
        table.append((f"10^{exponent}", f"{seconds * 1e9:,.0f}", f"{before:,.0f}", f"{after:,.0f}"))
    head = ("poses", "CPU, ns per pose", "memory with the poses, MiB", "peak above it, MiB")
    return markdown(head, table)


def ranking(n: int) -> str:
    """Rank the 195 mechanisms over the same poses."""
    seconds, memory = processes.run(processes.CATALOGUE.format(n=n))
    return (
        f"Ranking the 195 mechanisms over {n:,} poses, five indices, all cores: "
        f"{seconds:,.0f} s of wall time, {memory:,.0f} MiB at most."
    )


def write(sections: dict[str, str]) -> None:
    """Replace the sections between their markers in the page."""
    text = PAGE.read_text(encoding="utf-8")
    for name, section in sections.items():
        pattern = rf"(<!-- {name} -->\n).*?(<!-- end -->)"
        text = re.sub(pattern, lambda m, s=section: m[1] + s + "\n" + m[2], text, flags=re.S)
    PAGE.write_text(text, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--rounds", type=int, default=9, help="how often each way runs")
    parser.add_argument("--largest", type=int, default=7, help="exponent of the most poses")
    parser.add_argument("--catalogue", type=int, default=100_000, help="poses of the ranking")
    parser.add_argument("--only", nargs="*", help="sections to measure")
    parser.add_argument("--dry", action="store_true", help="print only, leave the page alone")
    options = parser.parse_args()
    jobs = {
        "machine": lambda: (
            f"{_processor()}, Python {platform.python_version()}, "
            f"numpy {np.__version__}, gsp {gsp.__version__}."
        ),
        "ups": lambda: ups(options.rounds),
        "limit": lambda: limit.section(options.rounds),
        "indices": lambda: single_indices(options.rounds),
        "mixed": lambda: mixed(options.rounds),
        "cores": lambda: cores(options.rounds),
        "latency": lambda: latency(options.rounds),
        "forward": lambda: bench_forward.section(options.rounds),
        "modes": lambda: bench_modes.section(options.rounds),
        "statics": lambda: bench_statics.section(options.rounds),
        "start": start,
        "processes": lambda: whole(options.rounds),
        "growth": lambda: growth(options.largest),
        "ranking": lambda: ranking(options.catalogue),
        "exploration": lambda: bench_exploration.section(options.rounds),
        "proofs": bench_proofs.section,
        "sets": bench_sets.section,
        "app": bench_app.section,
    }
    sections = {}
    for name, job in jobs.items():
        if not options.only or name in options.only:
            sections[name] = job()
            print(f"## {name}\n\n{sections[name]}\n", flush=True)
    if not options.dry:
        write(sections)


def _processor() -> str:
    try:
        info = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor()
    match = re.search(r"model name\s*:\s*(.*)", info)
    wide = "with" if "avx512f" in info else "without"
    return f"{match[1] if match else platform.machine()} ({wide} AVX-512)"


if __name__ == "__main__":
    main()

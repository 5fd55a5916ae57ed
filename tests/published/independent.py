"""Equations (2)–(6) of TozKucuk2016 and central differences of them in 40 digits.

Written afresh from the paper, from the text of the design files alone.
"""

import tomllib

import mpmath as mp

from gsp.files.knowledge import knowledge

mp.mp.dps = 40
STEP = mp.mpf("1e-13")


def vector(values):
    return mp.matrix([mp.mpf(repr(v)) for v in values])


def cross(x, y):
    return mp.matrix(
        [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
    )


def dot(x, y):
    return mp.fsum(x[i] * y[i] for i in range(3))


def unit(x):
    return x / mp.sqrt(dot(x, x))


def rz_ry_rx(a, b, c):
    rx = mp.matrix([[1, 0, 0], [0, mp.cos(a), -mp.sin(a)], [0, mp.sin(a), mp.cos(a)]])
    ry = mp.matrix([[mp.cos(b), 0, mp.sin(b)], [0, 1, 0], [-mp.sin(b), 0, mp.cos(b)]])
    rz = mp.matrix([[mp.cos(c), -mp.sin(c), 0], [mp.sin(c), mp.cos(c), 0], [0, 0, 1]])
    return rz * ry * rx


def joints(name, position, rotation):
    """Joint variables of a design by eqs. (2)–(6), in row order; angles in radians."""
    text = knowledge("catalogue", "designs", f"{name}.toml").read_text(encoding="utf-8")
    values = []
    for leg in tomllib.loads(text)["legs"]:
        a, b = vector(leg["base_point"]), vector(leg["platform_point"])
        s = unit(vector(leg["base_second_point"]) - a) if "base_second_point" in leg else None
        t = None
        if "platform_second_point" in leg:
            t = rotation * unit(vector(leg["platform_second_point"]) - b)
        d = position + rotation * b - a
        values += [EQUATIONS[kind](d, s, t) for kind in leg["constraints"].split()]
    return values


EQUATIONS = {
    "D1": lambda d, s, t: mp.sqrt(dot(d, d)),
    "D2": lambda d, s, t: mp.sqrt(dot(cross(d, t), cross(d, t))),
    "D3": lambda d, s, t: mp.sqrt(dot(cross(d, s), cross(d, s))),
    "D4": lambda d, s, t: abs(dot(d, cross(t, s))) / mp.sqrt(dot(cross(t, s), cross(t, s))),
    "A1": lambda d, s, t: mp.acos(dot(t, s)),
}


def joints_at(name, position, rpy_deg):
    angles = [mp.radians(mp.mpf(repr(angle))) for angle in rpy_deg]
    return joints(name, vector(position), rz_ry_rx(*angles))


def homogeneous_jacobian(name, position, rpy_deg, length):
    """Rows by central differences; the moment part of distances is divided by the length."""
    p = vector(position)
    r = rz_ry_rx(*(mp.radians(mp.mpf(repr(angle))) for angle in rpy_deg))
    start = joints(name, p, r)
    columns = []
    for axis in range(6):
        ends = []
        for sign in (1, -1):
            turn, shift = [0, 0, 0], [0, 0, 0]
            (shift if axis < 3 else turn)[axis % 3] = sign * STEP
            ends.append(joints(name, p + mp.matrix(shift), rz_ry_rx(*turn) * r))
        columns.append([(x - y) / (2 * STEP) for x, y in zip(*ends, strict=True)])
    angular = kinds(name)
    scale = mp.mpf(repr(length))
    return [
        [columns[k][i] / (scale if k >= 3 and not angular[i] else 1) for k in range(6)]
        for i in range(len(start))
    ]


def kinds(name):
    """Which rows are angles."""
    text = knowledge("catalogue", "designs", f"{name}.toml").read_text(encoding="utf-8")
    legs = tomllib.loads(text)["legs"]
    return [kind == "A1" for leg in legs for kind in leg["constraints"].split()]

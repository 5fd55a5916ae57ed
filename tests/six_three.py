"""The 6–3 platform of Workspace-3, written afresh from eqs. (3.3) and (3.4)."""

import numpy as np
import pytest

import gsp

A, B, D = 10.0, 15.0, 1.0
LOW, HIGH = 8.0, 15.0
S = np.sqrt(3.0)
RADIATING = (0.0, 0.0, 7.803616353940155)


def leg_lengths(x, y, z, alpha, beta, gamma):
    """Eqs. (3.3) and (3.4), angles in radians."""
    sa, ca, sb, cb = np.sin(alpha), np.cos(alpha), np.sin(beta), np.cos(beta)

    def top(sign, angle):
        s, c = np.sin(angle), np.cos(angle)
        return (
            x + sign * A / S * (sa * sb * s + cb * c),
            y + sign * A / S * ca * s,
            z + sign * A / S * (sa * cb * s - sb * c),
        )

    (x1, y1, z1) = top(1, gamma + np.pi / 3)
    (x2, y2, z2) = top(-1, gamma)
    (x3, y3, z3) = top(1, gamma - np.pi / 3)
    return np.array(
        [
            np.hypot(np.hypot(x1 - D / (2 * S) - B / S, y1 - D / 2), z1),
            np.hypot(np.hypot(x1 - D / (2 * S) + B / (2 * S), y1 - D / 2 - B / 2), z1),
            np.hypot(np.hypot(x2 + D / S + B / (2 * S), y2 - B / 2), z2),
            np.hypot(np.hypot(x2 + D / S + B / (2 * S), y2 + B / 2), z2),
            np.hypot(np.hypot(x3 - D / (2 * S) + B / (2 * S), y3 + D / 2 + B / 2), z3),
            np.hypot(np.hypot(x3 - D / (2 * S) - B / S, y3 + D / 2), z3),
        ]
    )


@pytest.fixture(scope="session")
def platform():
    return gsp.catalogue.design("workspace-6-3")


@pytest.fixture(scope="session")
def formula():
    return leg_lengths

"""Calibration: dimensions and joint zero points from measurements."""

from gsp.calibration.calibrating import calibrate
from gsp.calibration.result import Calibration

__all__ = ["Calibration", "calibrate"]

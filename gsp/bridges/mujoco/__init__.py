"""Designs as MuJoCo models: their files, simulation, pictures, and rates of joints."""

from gsp.bridges.mujoco.mjcf import to_mjcf
from gsp.bridges.mujoco.rates import mujoco_rates
from gsp.bridges.mujoco.rendering import render, render_motion
from gsp.bridges.mujoco.simulation import Simulation, simulate

__all__ = ["Simulation", "mujoco_rates", "render", "render_motion", "simulate", "to_mjcf"]

"""Kinematics of designs with legs that are driven at the base."""

"""Regions: their cells and measures, their shapes, and the poses inside."""

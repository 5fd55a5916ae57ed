"""The panels beside the scene: motion, legs, assembly modes, recorded motions, plots, catalogue."""

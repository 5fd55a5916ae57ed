"""Numbers that the compiled search and its callers share."""

# The requested results of a patch: sums of these.
SPECTRA, CONES, JOINTS = 1, 2, 4
# Marks of the boxes: 0 … 5 is the coordinate that was halved.
PROVEN, OPEN = 6, 7
# How a search ends.
DONE, ENDED, VIOLATED, CHANGED = 0, 1, 2, 3
# Scalars of a quantity: bounds on the patch, bounds at its centre, and how much of the width of
# the bounds each coordinate makes.
LOW, HIGH, MID_LOW, MID_HIGH, PARTS, QUANTITY = 0, 1, 2, 3, 4, 10

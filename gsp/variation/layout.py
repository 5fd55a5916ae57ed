"""Numbers that the compiled search and its callers share."""

# What of a patch is wanted: sums of these.
SPECTRA, CONES, JOINTS, ELLIPSOID, CONTROL, CLEARANCE, POSITION = 1, 2, 4, 8, 16, 32, 64
# Added to SPECTRA: a search may bound σ_min and the condition number without singular values first.
SCREEN = 128
# Added to SCREEN: the second screen at once, which a search uses where the first is not enough.
SECOND_SCREEN = 256
# The indices that have bounds, in their order after the cones.
INDEX_ORDER = (
    "minimum_singular_value",
    "condition_number",
    "manipulability",
    "condition_number_ellipsoid",
    "control_number",
)
# Marks of the boxes: 0 … 5 is the coordinate that was halved.
PROVEN, OPEN = 6, 7
# How a search ends.
DONE, ENDED, VIOLATED, SIGN_CHANGED = 0, 1, 2, 3
# Scalars of a quantity: bounds on the patch, bounds at its centre, and how much of the width of
# the bounds each coordinate makes.
LOW, HIGH, MID_LOW, MID_HIGH, PARTS, QUANTITY_SCALARS = 0, 1, 2, 3, 4, 10

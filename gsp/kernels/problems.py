"""The problems that the compiled evaluation solves, and the rows of their results."""

# Bits of what is wanted: the homogeneous Jacobian, CDN_OE, CTN.
HOMOGENEOUS_PROBLEM, ELLIPSOID_PROBLEM, CONTROL_PROBLEM = 1, 2, 4

# Rows of the results: σ_min/σ_max, σ_min and |det| of the homogeneous Jacobian, then σ_min/σ_max
# of the two generalised problems.
RECIPROCAL, LEAST, VOLUME, ELLIPSOID_RECIPROCAL, CONTROL_RECIPROCAL = range(5)
RESULTS = 5

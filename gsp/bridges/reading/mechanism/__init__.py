"""The legs that a linkage of bodies and joints has, and the design that it is."""

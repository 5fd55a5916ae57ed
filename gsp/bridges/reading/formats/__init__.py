"""Files of each format as a linkage of bodies and joints, or as a design."""

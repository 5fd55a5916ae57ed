"""Branch and bound over boxes: what is to be proven, bounds on boxes, search, tree."""

"""The closed surface of what is proven inside of a region in space, as polygons and triangles."""

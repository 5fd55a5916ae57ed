"""A design as URDF and SDF: trees of links, the tags that close their loops, and their texts."""

"""Commands about the library: what it knows, and whether that is right."""

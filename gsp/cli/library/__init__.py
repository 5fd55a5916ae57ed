"""Commands about the library: its catalogue, its store, and its checks."""

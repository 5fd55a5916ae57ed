"""Commands about one design."""

"""What the browser tool knows and computes, without any part of the user interface."""

"""What the scene draws, as plain numbers, and the scene as a figure, without a web framework."""

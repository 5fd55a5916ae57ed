"""What the command line reads: options, poses and boxes, designs, and defaults."""

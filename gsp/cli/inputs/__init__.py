"""What the command line reads: options, poses and boxes, designs, and what is taken by default."""

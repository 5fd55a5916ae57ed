"""What is inside a region: poses, indices over them, parts without a singular pose."""

"""The search tree: cells of positions with their rotations, how they are decided and halved."""

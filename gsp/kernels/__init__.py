"""Small-matrix numerics over batches."""

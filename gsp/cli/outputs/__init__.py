"""What the command line writes: lines and tables on the terminal, pictures, texts of poses."""

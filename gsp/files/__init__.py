"""Safe writing, tables, positions in TOML texts, and where the data is."""

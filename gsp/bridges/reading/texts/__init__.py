"""XML, JSON and YAML whose mistakes are named by line and key."""

"""The explorer: a table of designs as a page in which points, lines and designs are linked."""

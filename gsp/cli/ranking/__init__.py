"""`gsp rank`: from designs and poses to a table of designs, best first."""

"""`gsp rank` and `gsp explore`: tables of many designs."""

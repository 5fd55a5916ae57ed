"""Formulas of small matrices and angles for any kind of number, without branches."""

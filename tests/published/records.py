"""The records of all papers, read once for the tests of this folder."""

from gsp import published

RECORDS = published.select()

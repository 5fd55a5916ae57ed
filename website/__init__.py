"""The documentation site: pages made from the records of the library, and its configuration.

Only `hooks` and `docstrings` need mkdocs; what a page says is made by the other modules, which the
tests import.
"""

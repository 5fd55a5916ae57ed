"""The documentation site: pages made from the records of the library, and its configuration.

Only `hooks` and `docstrings` need mkdocs; the text of pages is made by the other modules, which the
tests import.
"""

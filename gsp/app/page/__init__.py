"""The page of the browser tool, in NiceGUI."""

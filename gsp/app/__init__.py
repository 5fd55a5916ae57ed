"""The browser tool, `gsp app`; the web framework is imported when the server starts."""

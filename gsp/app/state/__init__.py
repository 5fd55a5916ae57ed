"""The state of the browser tool and what is computed from it, without the user interface."""

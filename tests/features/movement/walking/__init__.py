"""Models of how people walk, over HTTP."""

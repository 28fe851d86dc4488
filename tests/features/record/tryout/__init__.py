"""A scripted participant in the server."""

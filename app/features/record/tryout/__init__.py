"""A scripted participant in this very server, so that newcomers see a session."""

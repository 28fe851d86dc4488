"""Tests of the scripted participant in the server."""

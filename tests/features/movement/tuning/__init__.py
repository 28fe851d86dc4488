"""Tests of tunings as jobs of the server."""

"""Tests of what an erasure leaves in the database's files."""

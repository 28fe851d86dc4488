"""Tests of reading humanoid models from files."""

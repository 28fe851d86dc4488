"""Tests of humanoid models over HTTP."""

"""Tests of models of how people walk, over HTTP."""

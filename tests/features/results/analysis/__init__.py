"""Tests of tables, codebook and figures."""

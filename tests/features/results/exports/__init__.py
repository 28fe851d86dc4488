"""Tests of exports as tidy CSV with a codebook."""

"""Tidy CSV with a codebook."""

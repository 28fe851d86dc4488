"""Tests of the features, against real databases."""

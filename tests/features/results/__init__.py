"""Tests of the features in `app/features/results`."""

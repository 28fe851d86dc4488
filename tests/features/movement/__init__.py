"""Tests of the features in `app/features/movement`."""

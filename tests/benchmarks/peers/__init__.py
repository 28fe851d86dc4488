"""Measure other systems with the same frames, in the same run as ours."""

"""Measure other systems with the same frames and in the same run as the product."""

"""Synthetic walks."""

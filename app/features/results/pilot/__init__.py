"""Pilot: what a planned study would find if people were as its assumptions say."""

"""Walks and scenes out of files: 2-D tracks, foot sensors, and the floors people walk on."""

"""A lab full of headsets and consoles against the real server, and what they saw."""

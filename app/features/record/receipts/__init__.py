"""The receipt: what of a session is there, proven from what is stored."""

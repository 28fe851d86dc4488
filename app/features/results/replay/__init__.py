"""A phase looked at again: what moved, and what happened in step with it."""

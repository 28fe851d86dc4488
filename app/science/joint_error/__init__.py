"""Joint errors."""

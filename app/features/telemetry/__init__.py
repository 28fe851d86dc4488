"""Movement in, movement out."""

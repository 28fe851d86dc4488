"""What the record holds about a person: removing it, and overwriting what is left of it."""

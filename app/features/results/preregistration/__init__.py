"""What a study declared before it looked, what was done, and every way in which the two differ."""

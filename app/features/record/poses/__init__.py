"""The movement of a running session as consoles draw it: the newest pose, and nothing older."""

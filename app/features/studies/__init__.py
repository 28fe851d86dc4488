"""Studies and their versions."""

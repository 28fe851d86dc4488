"""Files of humanoid models."""

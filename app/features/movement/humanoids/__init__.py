"""Humanoid models that lend avatars their body: uploaded once, measured, named by their hash."""

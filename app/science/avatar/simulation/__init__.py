"""Stepping the model: the avatar's state, contacts, delay and switches."""

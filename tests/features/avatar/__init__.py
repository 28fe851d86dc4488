"""Configurations of avatars."""

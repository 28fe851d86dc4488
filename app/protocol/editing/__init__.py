"""Changing single values of a configuration file's text; every other character stays as it is."""

from app.protocol.editing.change import Action, Change
from app.protocol.editing.edit import edit_text

__all__ = ["Action", "Change", "edit_text"]

"""Changing single values of a configuration file's text; every other character stays as it is."""

from app.protocol.editing.change import Change
from app.protocol.editing.edit import edit_text

__all__ = ["Change", "edit_text"]

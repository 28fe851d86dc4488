"""Change single values in the text of a configuration file, leaving the rest unchanged."""

from app.protocol.editing.change import Change
from app.protocol.editing.edit import edit_text

__all__ = ["Change", "edit_text"]

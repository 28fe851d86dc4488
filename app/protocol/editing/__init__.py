"""Write configuration files: change single values in a text, or make the text of a new file."""

from app.protocol.editing.change import Change
from app.protocol.editing.edit import edit_text
from app.protocol.editing.writing import mapping_text

__all__ = ["Change", "edit_text", "mapping_text"]

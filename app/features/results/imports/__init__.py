"""Answers that were collected elsewhere: read, mapped, checked, taken in as a whole, undone.

They stay apart from the answers of sessions, in tables and exports too.
"""

from app.features.results.imports.service import forget_participant
from app.features.results.imports.stored import import_files, told_of

__all__ = ["forget_participant", "import_files", "told_of"]

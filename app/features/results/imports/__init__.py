"""Import answers that were collected elsewhere: read, map, check, store all or none, undo.

They are kept apart from the answers of sessions, in tables and in exports.
"""

from app.features.results.imports.offering import offer, offered_file, read_columns
from app.features.results.imports.repository import import_files, imported_answers_of
from app.features.results.imports.service import forget_participant

__all__ = [
    "forget_participant",
    "import_files",
    "imported_answers_of",
    "offer",
    "offered_file",
    "read_columns",
]

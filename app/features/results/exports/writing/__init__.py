"""Writing an export: its files in pieces, as a folder, as an archive, or in a process of its own.

It shows one moment of the database, and memory does not grow with what is written. Loads pandas.
"""

from app.features.results.exports.writing.contents import Member
from app.features.results.exports.writing.making import made
from app.features.results.exports.writing.service import (
    Exported,
    export_study,
    person_archive,
    study_archive,
    usual_kind,
)

__all__ = [
    "Exported",
    "Member",
    "export_study",
    "made",
    "person_archive",
    "study_archive",
    "usual_kind",
]

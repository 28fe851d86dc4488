"""Write an export in pieces, as a folder, as an archive, or in a worker process; loads pandas.

An export shows one moment of the database, and its memory does not grow with the amount of data.
"""

from app.features.results.exports.writing.contents import Member
from app.features.results.exports.writing.export_task import make_export
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
    "make_export",
    "person_archive",
    "study_archive",
    "usual_kind",
]

"""Studies and their versions: validated files, identified by the hash of their content.

A version that a session has started with is frozen; an edit makes a new one. The content of a
stored version is parsed once and cached.
"""

from app.features.design.studies.service import (
    add_shipped,
    add_version,
    create_study,
    faulty_studies,
    freeze,
    instrument_for,
    newest_version,
    protocol_of,
    require_open,
    shipped_files,
    study_by_key,
    versions_of,
)
from app.features.design.studies.versions import UsedInstrument, used_instrument, version_content

__all__ = [
    "UsedInstrument",
    "add_shipped",
    "add_version",
    "create_study",
    "faulty_studies",
    "freeze",
    "instrument_for",
    "newest_version",
    "protocol_of",
    "require_open",
    "shipped_files",
    "study_by_key",
    "used_instrument",
    "version_content",
    "versions_of",
]

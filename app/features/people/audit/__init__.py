"""The audit trail of the lab: hash-chained, so that any later change is detectable.

`record` appends an entry to the trail, and `record_copy` records that data leave the database. Both
run within the caller's transaction.
"""

from app.features.people.audit.copies import (
    COMMAND_LINE,
    MAX_PLACE_LENGTH,
    count_sessions,
    download_place,
    record_copy,
)
from app.features.people.audit.service import (
    AuditCheck,
    TrailHead,
    contains_head,
    head_of,
    record,
    verify_trail,
)

__all__ = [
    "COMMAND_LINE",
    "MAX_PLACE_LENGTH",
    "AuditCheck",
    "TrailHead",
    "contains_head",
    "count_sessions",
    "download_place",
    "head_of",
    "record",
    "record_copy",
    "verify_trail",
]

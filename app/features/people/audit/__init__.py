"""What people of the lab did, on a chain that shows every later change.

`record` appends an act to the trail, `record_copy` notes data that leave the database: both within
the caller's transaction.
"""

from app.features.people.audit.copies import (
    COMMAND_LINE,
    LONGEST_PLACE,
    in_browser_of,
    record_copy,
    sessions_in,
)
from app.features.people.audit.service import (
    AuditCheck,
    TrailHead,
    head_of,
    holds_head,
    record,
    verify_trail,
)

__all__ = [
    "COMMAND_LINE",
    "LONGEST_PLACE",
    "AuditCheck",
    "TrailHead",
    "head_of",
    "holds_head",
    "in_browser_of",
    "record",
    "record_copy",
    "sessions_in",
    "verify_trail",
]

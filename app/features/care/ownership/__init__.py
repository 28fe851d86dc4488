"""Ensure that one process owns the data: the server, or a command that changes many rows.

owner           the description of an owner, as text for other processes folder_lock     the
operating system's lock on a folder database_lock   the lock of a PostgreSQL database service
take both locks, detect a loss, and allow commands alongside an owner
"""

from app.features.care.ownership.owner import Owned
from app.features.care.ownership.service import (
    Ownership,
    OwnerWatch,
    own_data,
    prepared_beside_owner,
)

__all__ = ["Owned", "OwnerWatch", "Ownership", "own_data", "prepared_beside_owner"]

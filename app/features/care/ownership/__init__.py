"""One owner for the data: the server, or a command that changes more than a row of its own.

owner           who that is, as text that others read
folder_lock     the operating system's lock on a folder
database_lock   the lock of a PostgreSQL database
service         taking both, noticing a loss, and what else may work beside an owner
"""

from app.features.care.ownership.owner import Owned
from app.features.care.ownership.service import (
    Ownership,
    OwnerWatch,
    own_data,
    prepared_beside_owner,
)

__all__ = ["Owned", "OwnerWatch", "Ownership", "own_data", "prepared_beside_owner"]

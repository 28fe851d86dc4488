"""A copy of everything in one file, made and put back while the server runs.

The file is a SQLite database with the product's own schema, whichever engine it came from, plus a
manifest with a checksum of every table. So a backup of one engine can be restored on the other, it
can be looked into with any SQLite tool, and damage is noticed before anything is replaced.

shapes     the tables of a schema, as far as copying needs to know them
rows       rows in one form that is the same on both engines
digest     checksums over such rows
readable   whether this program can read what rows mean
content    whether rows and tables are ones that this program can have written
manifest   what a backup says of itself
writing    making the file
reading    opening the file, whole and in the newest schema
restoring  putting its rows in the place of a database's
service    backing up and restoring, as others use them
"""

from app.features.care.backups.content import (
    RestoredContent,
    columns_in,
    wrong_rows,
    wrong_tables,
)
from app.features.care.backups.readable import Lifetimes
from app.features.care.backups.reading import Backup
from app.features.care.backups.service import (
    ENDING,
    BackedUp,
    Restored,
    back_up,
    checked_backup,
    holds_people,
    restore,
    stamped,
)
from app.features.care.backups.shapes import TableShape
from app.features.care.backups.writing import shapes_at

__all__ = [
    "ENDING",
    "BackedUp",
    "Backup",
    "Lifetimes",
    "Restored",
    "RestoredContent",
    "TableShape",
    "back_up",
    "checked_backup",
    "columns_in",
    "holds_people",
    "restore",
    "shapes_at",
    "stamped",
    "wrong_rows",
    "wrong_tables",
]

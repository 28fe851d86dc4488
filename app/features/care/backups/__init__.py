"""Back up everything to one file, and restore it, while the server runs.

The file is a SQLite database with the product's own schema, whichever engine it came from, plus a
manifest with a checksum of every table. So a backup of one engine can be restored on the other, it
can be inspected with any SQLite tool, and damage is detected before anything is replaced.

shapes     the tables of a schema, as far as copying needs to know them
rows       rows in a form that is the same on both engines
digest     checksums over such rows
readable   whether this program can interpret the rows
content    whether this program can have written the rows and tables
manifest   the description of a backup inside its file
writing    write the file
reading    open the file, checked and in the newest schema
restoring  replace the rows of a database by those of the file
service    backing up and restoring, for use by other features
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

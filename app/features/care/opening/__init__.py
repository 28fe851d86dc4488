"""Open the database safely at every start: inspect, quarantine, create, back up, migrate.

wal          detect committed transactions that SQLite's write-ahead log lost
inspection   detect damage of a SQLite file
quarantine   move a damaged database away without deleting it
service      the steps of every start: inspect, quarantine, create, back up, migrate
"""

from app.features.care.opening.service import (
    Damaged,
    bring_up_to_date,
    created_if_missing,
    existing_database,
    prepare_database,
    quarantine_if_damaged,
)

__all__ = [
    "Damaged",
    "bring_up_to_date",
    "created_if_missing",
    "existing_database",
    "prepare_database",
    "quarantine_if_damaged",
]

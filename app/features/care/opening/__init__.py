"""Open the database safely at every start: inspect, quarantine, create, back up, migrate.

wal          detect committed transactions that SQLite's write-ahead log lost
inspection   detect damage of a SQLite file
quarantine   move a damaged database away without deleting it
service      the steps of every start: inspect, quarantine, create, back up, migrate
"""

from app.features.care.opening.service import (
    Damaged,
    begun_if_missing,
    bring_up_to_date,
    existing_database,
    prepare_database,
    put_away_if_damaged,
)

__all__ = [
    "Damaged",
    "begun_if_missing",
    "bring_up_to_date",
    "existing_database",
    "prepare_database",
    "put_away_if_damaged",
]

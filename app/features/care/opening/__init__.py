"""Makes sure that the database can be worked with before anything works with it.

wal          whether SQLite's log lost transactions that had been committed
inspection   what is wrong with a SQLite file
quarantine   putting a damaged database away, never deleting it
service      what happens at every start: inspect, put away, create, back up, migrate
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

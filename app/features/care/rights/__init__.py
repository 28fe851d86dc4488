"""Participants' rights after a session: a copy of their data, corrections and erasure.

An erasure is permanent: in a database from an older backup it is repeated at the start
(`finish_erasures`) and within a restore (`ErasureReplay`).

erasing       one erasure, in one transaction tombstones    the list of erasures next to the
database, which outlives a restored backup service       repeat erasures in databases from older
backups copies        exports, access copies and backups that left the database corrections   later
values of answers, with their reasons participants  the participants of a study access        a
person's own copy, as a page to read and as data
"""

from app.features.care.rights.service import ErasureReplay, finish_erasures, knows_erasures
from app.features.care.rights.tombstones import Tombstone, read_list, tombstone_file

__all__ = [
    "ErasureReplay",
    "Tombstone",
    "finish_erasures",
    "knows_erasures",
    "read_list",
    "tombstone_file",
]

"""Participants' rights, as the rest of the product asks for them."""

import logging

from app.errors import NotDurable
from app.features.care.rights.again import ErasuresKept, erase_again
from app.features.care.rights.erasing import erase, erasure_of, participant_of, require_erasable
from app.features.care.rights.tombstones import tombstone_file, tombstones_of
from app.features.record.erasure import expect_erasure, overwrite_what_is_left
from app.platform.context import AppContext

__all__ = [
    "ErasuresKept",
    "erase",
    "erasure_of",
    "finish_erasures",
    "keep_tombstones",
    "participant_of",
    "require_erasable",
]
log = logging.getLogger(__name__)


def finish_erasures(context: AppContext) -> int:
    """At a start: complete the list, erase again what came back, overwrite what was left.

    Returns how many erasures were made again: somebody put an older file in the database's place.
    """
    database, settings = context.database, context.settings
    listed = tombstone_file(settings).read()
    again = 0
    if listed:
        with database.writing() as db:
            again = erase_again(db, context, listed)
    try:
        keep_tombstones(context)
    except NotDurable as error:
        log.warning("%s. %s", error.message, error.remedy)
    if again:
        expect_erasure(settings)
        log.warning("%d erasure(s) that the database did not know were made again", again)
    overwrite_what_is_left(database, settings)
    return again


def keep_tombstones(context: AppContext) -> None:
    """Complete the list beside the database from its table; raises NotDurable."""
    with context.database.reading() as db:
        known = tombstones_of(db)
    tombstone_file(context.settings).add(known)

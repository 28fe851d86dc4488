"""A fixture with a session that has movement in two epochs, and its receipt."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest
from sqlalchemy import update
from sqlalchemy.orm import Session

from app.database import Database, open_database
from app.features.record.receipts.service import SessionReceipt, receipt_of
from app.features.record.receipts.streams import StreamReceipt
from app.models import TelemetryStream
from app.wire import BODY_STREAMS, StreamName
from tests.features.builders import SessionSpec, build_session, build_study
from tests.features.movement_builders import moving_values, store_chunks

FRAMES = 400


@dataclass(frozen=True)
class StoredSession:
    """A stored session, whose `receipt()` is computed at each call."""

    database: Database
    session_id: str

    def change(self, act: Callable[[Session], object]) -> None:
        """Change the session's record directly in the database."""
        with self.database.writing() as db:
            act(db)

    def receipt(self, *, blinded: bool = False) -> SessionReceipt:
        """Return the current receipt of the session, as blinded readers see it if they ask."""
        with self.database.reading() as db:
            return receipt_of(db, self.session_id, blinded=blinded)

    def stream(self, name: str = "target", epoch: int = 1) -> StreamReceipt:
        """Return one stream of the current receipt."""
        return next(
            one for one in self.receipt().streams if (one.stream, one.epoch) == (name, epoch)
        )


@pytest.fixture
def stored(database_url: str) -> Iterator[StoredSession]:
    """Yield a session: 400 frames of both bodies in epoch 1, 100 of the target in epoch 2."""
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
        session_id = build_session(db, SessionSpec("P-0001")).id
        for seed, stream in enumerate(BODY_STREAMS):
            store_chunks(db, session_id, stream, range(FRAMES), moving_values(FRAMES, seed))
        store_chunks(db, session_id, StreamName.TARGET, range(100), moving_values(100, 9), epoch=2)
        db.execute(update(TelemetryStream).values(produced=TelemetryStream.next_seq))
    yield StoredSession(database, session_id)
    database.close()

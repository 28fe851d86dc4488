"""Compress chunks in a separate process, which reads the batches itself and returns the chunks.

In a thread, compression would delay the event loop and the writer, since they share one
interpreter. The process never writes to the database, and ends with the server, however the server
ends.
"""

import contextlib
import multiprocessing
import os
import signal
import threading
from dataclasses import dataclass, field
from datetime import datetime
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any

from sqlalchemy import make_url
from sqlalchemy.orm import Session

from app.database import make_engine
from app.features.record.telemetry.due import Chunks, due_chunks

NICENESS = 5
"""The process has a lower priority than the server: chunks can wait, acknowledgements cannot."""
ENDS_WITHIN_S = 10.0


class EncoderError(RuntimeError):
    """The process has died or its request failed; the next request starts a new process."""


@dataclass
class Encoder:
    """The encoding process for the database at `url`, started on the first request."""

    url: str
    _context: SpawnContext = field(default_factory=lambda: multiprocessing.get_context("spawn"))
    _process: SpawnProcess | None = None
    _line: "Connection[Any, Any] | None" = None
    # On a slow machine, a server may be stopped while the process is still starting.
    _changing: threading.RLock = field(default_factory=threading.RLock)

    @property
    def pid(self) -> int | None:
        """Return the id of the process, or None if it is not running."""
        return None if self._process is None else self._process.pid

    def due_chunks(self, now: datetime) -> Chunks:
        """Return the chunks that are due at `now` (see the module `due`); raises EncoderError."""
        line = self.begin()
        try:
            line.send(now)
            answer = line.recv()
        except (OSError, EOFError) as error:
            self.end()
            raise EncoderError("the encoding process has ended") from error
        if isinstance(answer, str):
            raise EncoderError(answer)
        chunks: Chunks = answer
        return chunks

    def end(self) -> None:
        """End the process; a later request starts a new one."""
        with self._changing:
            if self._line is not None:
                self._line.close()
            if self._process is not None:
                self._process.join(ENDS_WITHIN_S)
                if self._process.is_alive():
                    self._process.kill()
                    self._process.join()
            self._line = self._process = None

    def begin(self) -> "Connection[Any, Any]":
        """Start the process if it is not running, for example before movement is expected."""
        with self._changing:
            if self._line is not None:
                return self._line
            ours, theirs = self._context.Pipe()
            process = self._context.Process(
                target=serve, args=(theirs, self.url), name="telemetry-encoder", daemon=True
            )
            process.start()
            # Only the process has the other end open now, so each side notices the death of the
            # other.
            theirs.close()
            self._process, self._line = process, ours
            return ours


def serve(line: "Connection[Any, Any]", url: str) -> None:
    """Answer requests until the other end of the pipe is closed; runs in the encoding process."""
    # Ctrl-C reaches every process of a terminal, but the server decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    # A database file may be replaced between two requests, so each opens its own connection.
    engine = make_engine(url, pooled=make_url(url).get_backend_name() != "sqlite")
    with contextlib.suppress(EOFError, OSError):
        while True:
            line.send(_answer(Session(engine), line.recv()))


def _answer(db: Session, now: datetime) -> Chunks | str:
    try:
        with db:
            return due_chunks(db, now)
    except Exception as error:  # noqa: BLE001  # any error is returned, and logged by the server
        return f"{type(error).__name__}: {error}"

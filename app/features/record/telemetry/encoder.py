"""Compression in a process of its own, which reads the batches itself and hands back chunks.

In a thread it would hold up the event loop and the writer, at every array it touches: they share
one interpreter. The process never writes, and ends with the server, however that ends.
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
"""The server goes first where both want the processor: chunks can wait, acknowledgements not."""
ENDS_WITHIN_S = 10.0


class EncoderError(RuntimeError):
    """The process has died, or could not do what it was asked; asked again it is started anew."""


@dataclass
class Encoder:
    """The process for the database at `url`, begun when it is first asked for something."""

    url: str
    _context: SpawnContext = field(default_factory=lambda: multiprocessing.get_context("spawn"))
    _process: SpawnProcess | None = None
    _line: "Connection[Any, Any] | None" = None
    # On a slow machine a server may stop while the process is still being started.
    _changing: threading.RLock = field(default_factory=threading.RLock)

    @property
    def pid(self) -> int | None:
        """The process, if there is one."""
        return None if self._process is None else self._process.pid

    def due_chunks(self, now: datetime) -> Chunks:
        """What is due at `now`, as `due_chunks` of the module `due`; raises EncoderError."""
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
        """Let it go; it may be asked again."""
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
        """Start the process, unless it runs: where movement is to come, before there is any."""
        with self._changing:
            if self._line is not None:
                return self._line
            ours, theirs = self._context.Pipe()
            process = self._context.Process(
                target=serve, args=(theirs, self.url), name="telemetry-encoder", daemon=True
            )
            process.start()
            # Only the process holds the other end now, so each notices the death of the other.
            theirs.close()
            self._process, self._line = process, ours
            return ours


def serve(line: "Connection[Any, Any]", url: str) -> None:
    """Answer questions until the other end is closed."""
    # Ctrl-C reaches every process of a terminal; when to end is for the server to say.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    # With a file, a connection for each question: it may be another file by the next.
    engine = make_engine(url, pooled=make_url(url).get_backend_name() != "sqlite")
    with contextlib.suppress(EOFError, OSError):
        while True:
            line.send(_answer(Session(engine), line.recv()))


def _answer(db: Session, now: datetime) -> Chunks | str:
    try:
        with db:
            return due_chunks(db, now)
    except Exception as error:  # noqa: BLE001  # whatever it is, it is told and logged there
        return f"{type(error).__name__}: {error}"

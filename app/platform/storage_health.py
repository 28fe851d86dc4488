"""Whether the record can be written: what went wrong, since when, and what to do about it.

Told of every writing transaction by the database (`failed`, `succeeded`). With a headset connected
there is one a second at least, so trouble is known within a second. While it lasts nothing is
acknowledged, headsets keep what they have, and whatever would start something new is refused
(`require_storage`). Everything goes on by itself with the first commit that succeeds.
"""

import logging
import shutil
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict

from app.clock import Clock
from app.errors import NotDurable
from app.platform.space_reserve import SpaceReserve
from app.platform.trouble import FULL, Trouble, explain

log = logging.getLogger(__name__)
LOOK_EVERY_NS = TRY_AGAIN_NS = 5_000_000_000


@dataclass(frozen=True)
class Failure:
    """Trouble that lasts: since when, and when it was last met (ns, monotonic)."""

    since: datetime
    last_ns: int
    trouble: Trouble


class StorageState(BaseModel):
    """`reason` and `remedy` are set while it fails; `low_disk` warns before it does."""

    model_config = ConfigDict(frozen=True)

    status: Literal["ok", "failing"] = "ok"
    since: datetime | None = None
    reason: str | None = None
    remedy: str | None = None
    low_disk: bool = False


@dataclass(frozen=True)
class Outage:
    """A time, now over, in which nothing could be stored."""

    since: datetime
    until: datetime
    reason: str


@dataclass(eq=False)
class StorageHealth:
    """Safe from any thread. `on_change` is called when it begins and ceases to fail."""

    clock: Clock
    folder: Path
    low_disk_bytes: int
    on_change: Callable[[], None] = lambda: None
    free_bytes: Callable[[Path], int] = lambda folder: shutil.disk_usage(folder).free
    reserve: SpaceReserve = field(default_factory=lambda: SpaceReserve(None))
    _failure: Failure | None = None
    _outages: list[Outage] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _low_disk: bool = False
    _looked_ns: int | None = None

    def failed(self, error: Exception) -> None:
        """A writing transaction did not come about; only trouble with storage counts."""
        trouble = explain(error)
        if trouble is None:
            return
        now, now_ns = self.clock.utc_now(), self.clock.monotonic_ns()
        with self._lock:
            before = self._failure
            self._failure = Failure(before.since if before else now, now_ns, trouble)
        if before is None or before.trouble != trouble:
            words = str(getattr(error, "orig", error))
            log.error("%s (%s); nothing is acknowledged", trouble.message, words)
            self.on_change()

    def succeeded(self) -> None:
        """Changes are on disk; that counts only if they did not need the reserve for it."""
        if self._failure is None:
            return
        with self._lock:
            if not self.reserve.take_back():
                return
            failure, self._failure = self._failure, None
            if failure is None:
                return
            outage = Outage(failure.since, self.clock.utc_now(), failure.trouble.message)
            self._outages.append(outage)
        log.warning("the record is written again; it was not since %s", outage.since.isoformat())
        self.on_change()

    def make_room(self) -> None:
        """For whatever frees space, before it writes: on a full disk it has the reserve."""
        failure = self._failure
        if failure is not None and failure.trouble == FULL:
            with self._lock:
                self.reserve.give_up()

    def must_wait(self) -> bool:
        """Whether what fills the disk has to wait, until the reserve is there again."""
        if not self.reserve.given_up:
            return False
        with self._lock:
            return not self.reserve.take_back()

    def is_untried(self, for_ns: int) -> bool:
        """Whether it fails, and nobody has tried to write for so long."""
        failure = self._failure
        return failure is not None and self.clock.monotonic_ns() - failure.last_ns > for_ns

    def take_outages(self) -> tuple[Outage, ...]:
        """The outages that are over, each told once: for whoever puts them on record."""
        with self._lock:
            taken, self._outages = tuple(self._outages), []
        return taken

    def state(self) -> StorageState:
        """How it stands now. The disk's space is looked at every few seconds, when asked for."""
        low_disk, failure = self._is_low(), self._failure
        if failure is None:
            return StorageState(low_disk=low_disk)
        return StorageState(
            status="failing",
            since=failure.since,
            reason=failure.trouble.message,
            remedy=failure.trouble.remedy,
            low_disk=low_disk,
        )

    def require_storage(self) -> None:
        """For whatever starts something: raises NotDurable while nothing can be stored.

        When nobody has tried for a while, this one may: without headsets nobody else would.
        """
        failure = self._failure
        if failure is None or self.clock.monotonic_ns() - failure.last_ns > TRY_AGAIN_NS:
            return
        raise NotDurable(
            f"{failure.trouble.message}, so nothing new is started",
            value=f"nothing was stored since {failure.since.isoformat(timespec='seconds')}",
            remedy=failure.trouble.remedy,
        )

    def _is_low(self) -> bool:
        now_ns = self.clock.monotonic_ns()
        with self._lock:
            if self._looked_ns is None or now_ns - self._looked_ns >= LOOK_EVERY_NS:
                self._looked_ns = now_ns
                self._low_disk = self._free() < self.low_disk_bytes
            return self._low_disk

    def _free(self) -> float:
        try:
            return self.free_bytes(self.folder)
        except OSError:
            # No such folder: the data are somewhere else, on a database server.
            return float("inf")

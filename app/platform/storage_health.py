"""Track whether the record can be written: what failed, since when, and what to do about it.

The database reports every writing transaction (`failed`, `succeeded`). With a headset connected
there is at least one per second, so trouble is detected within a second. While it lasts nothing is
acknowledged, headsets keep their data, and requests that would start something new are refused
(`require_storage`). Normal operation resumes with the first commit that succeeds.
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
    """A persisting storage failure: since when, and when it last occurred (ns, monotonic)."""

    since: datetime
    last_ns: int
    trouble: Trouble


class StorageState(BaseModel):
    """The state of storage; `reason` and `remedy` are set while it fails.

    `low_disk` warns before it fails.
    """

    model_config = ConfigDict(frozen=True)

    status: Literal["ok", "failing"] = "ok"
    since: datetime | None = None
    reason: str | None = None
    remedy: str | None = None
    low_disk: bool = False


@dataclass(frozen=True)
class Outage:
    """A period, now over, during which nothing could be stored."""

    since: datetime
    until: datetime
    reason: str


@dataclass(eq=False)
class StorageHealth:
    """The state of storage, safe to use from any thread.

    `on_change` is called when storage starts to fail and when it recovers.
    """

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
        """Record that a writing transaction failed, if the error is a storage failure."""
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
        """Record that changes are on disk, which ends a failure.

        A failure ends only if the disk reserve can be restored, too.
        """
        if self._failure is None:
            return
        with self._lock:
            if not self.reserve.restore():
                return
            failure, self._failure = self._failure, None
            if failure is None:
                return
            outage = Outage(failure.since, self.clock.utc_now(), failure.trouble.message)
            self._outages.append(outage)
        log.warning("the record is written again; it had failed since %s", outage.since.isoformat())
        self.on_change()

    def make_room(self) -> None:
        """Release the disk reserve if the disk is full; call it before a write that frees space."""
        failure = self._failure
        if failure is not None and failure.trouble == FULL:
            with self._lock:
                self.reserve.release()

    def must_wait(self) -> bool:
        """Return whether writes that fill the disk have to wait until the reserve is restored."""
        if not self.reserve.is_released:
            return False
        with self._lock:
            return not self.reserve.restore()

    def is_untried(self, for_ns: int) -> bool:
        """Return whether storage fails and no write was attempted for `for_ns`."""
        failure = self._failure
        return failure is not None and self.clock.monotonic_ns() - failure.last_ns > for_ns

    def take_outages(self) -> tuple[Outage, ...]:
        """Return the outages that are over, each exactly once, for the caller to record."""
        with self._lock:
            taken, self._outages = tuple(self._outages), []
        return taken

    def state(self) -> StorageState:
        """Return the current state; free disk space is measured at most every few seconds."""
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
        """Raise NotDurable while nothing can be stored; for requests that start something new.

        If no write was attempted for a while, the request may pass: without headsets there would be
        no other attempt.
        """
        failure = self._failure
        if failure is None or self.clock.monotonic_ns() - failure.last_ns > TRY_AGAIN_NS:
            return
        raise NotDurable(
            f"{failure.trouble.message}, so nothing new can be started",
            value=f"nothing has been stored since {failure.since.isoformat(timespec='seconds')}",
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
            # The folder does not exist: the data are elsewhere, on a database server.
            return float("inf")

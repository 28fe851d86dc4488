"""Notify the pages and headsets of a session that something changed.

A subscriber has one slot per topic, not a queue: a slow reader misses intermediate news and gets
the newest, so an idle reader cannot make the server's memory grow. The record does not depend on
this: it is in the database before anything is published.
"""

import asyncio
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from sqlalchemy.orm import Session

from app.database import after_commit


@dataclass(eq=False)
class Subscription:
    """One reader's newest unread news, by topic.

    News of topics other than `topics` is not delivered.
    """

    loop: asyncio.AbstractEventLoop
    topics: frozenset[str]
    _news: dict[str, Any] = field(default_factory=dict)
    _arrived: asyncio.Event = field(default_factory=asyncio.Event)

    def offer(self, topic: str, value: Any) -> None:
        """Deliver news from any thread, replacing unread news of the same topic."""
        try:
            self.loop.call_soon_threadsafe(self._put, topic, value)
        except RuntimeError:  # the loop is closing: this reader is gone
            return

    def _put(self, topic: str, value: Any) -> None:
        self._news[topic] = value
        self._arrived.set()

    async def next(self, timeout_s: float) -> dict[str, Any]:
        """Return all unread news, waiting up to `timeout_s`; empty if none arrived."""
        try:
            # Not wait_for: on Python 3.11 it swallows a cancellation that coincides with the news.
            async with asyncio.timeout(timeout_s):
                await self._arrived.wait()
        except TimeoutError:
            return {}
        self._arrived.clear()
        news, self._news = self._news, {}
        return news


@dataclass(eq=False)
class Hub:
    """The subscribers of each session, and the headsets that are connected now."""

    _subscribers: dict[str, set[Subscription]] = field(default_factory=dict)
    _headsets: dict[str, int] = field(default_factory=dict)
    _abilities: dict[str, frozenset[str]] = field(default_factory=dict)
    _heard_s: dict[str, float] = field(default_factory=dict)
    _seen: dict[str, datetime] = field(default_factory=dict)
    _left: dict[str, datetime] = field(default_factory=dict)
    _signals: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def note_seen(self, device_id: str, now: datetime) -> None:
        """Record that a device has just sent a request."""
        with self._lock:
            self._seen[device_id] = now

    def last_seen(self, device_id: str) -> datetime | None:
        """Return when a device last sent a request; None if it has not since the server started."""
        with self._lock:
            return self._seen.get(device_id)

    @contextmanager
    def subscribe(self, session_id: str, *more: str) -> Iterator[Subscription]:
        """Subscribe to a session's changes and to `more` topics, within a running event loop."""
        subscription = Subscription(asyncio.get_running_loop(), frozenset(("session", *more)))
        with self._lock:
            self._subscribers.setdefault(session_id, set()).add(subscription)
        try:
            yield subscription
        finally:
            with self._lock:
                readers = self._subscribers.get(session_id, set())
                readers.discard(subscription)
                if not readers:
                    self._subscribers.pop(session_id, None)

    def publish(self, session_id: str, topic: str, value: Any = None) -> None:
        """Deliver news to every reader of a session, from any thread."""
        with self._lock:
            readers = tuple(self._subscribers.get(session_id, ()))
        for reader in readers:
            if topic in reader.topics:
                reader.offer(topic, value)

    def has_listeners(self, session_id: str, topic: str) -> bool:
        """Return whether anybody subscribes to a topic: if nobody does, no news need be made."""
        with self._lock:
            readers = self._subscribers.get(session_id, ())
            return any(topic in reader.topics for reader in readers)

    def publish_after_commit(self, db: Session, session_id: str) -> None:
        """Publish "session changed" only once this transaction is on disk."""
        after_commit(db, lambda: self.publish(session_id, "session"))

    def publish_storage(self) -> None:
        """Notify every reader that storage or a background task has failed or recovered."""
        with self._lock:
            readers = [reader for group in self._subscribers.values() for reader in group]
        for reader in readers:
            reader.offer("storage", None)

    def publish_access(self) -> None:
        """Make every reader of every session check whether it may still read."""
        with self._lock:
            readers = [reader for group in self._subscribers.values() for reader in group]
        for reader in readers:
            reader.offer("access", None)

    def headset_joined(self, session_id: str, *, abilities: frozenset[str] = frozenset()) -> None:
        """Record that a headset's socket was opened.

        `abilities`: what its program said that it can do, by the names of its hello message.
        """
        with self._lock:
            self._abilities[session_id] = abilities
            self._headsets[session_id] = self._headsets.get(session_id, 0) + 1

    def headset_left_at(self, session_id: str) -> datetime | None:
        """Return when the session's last headset socket closed; None if none has, or one is open.

        A headset sends no requests while its socket is open, so `last_seen` cannot tell.
        """
        with self._lock:
            return None if session_id in self._headsets else self._left.get(session_id)

    def headset_left(self, session_id: str, now: datetime | None = None) -> None:
        """Record that a headset's socket was closed."""
        with self._lock:
            if now is not None:
                self._left[session_id] = now
            left = self._headsets.get(session_id, 0) - 1
            if left > 0:
                self._headsets[session_id] = left
            else:
                self._headsets.pop(session_id, None)
                self._abilities.pop(session_id, None)
                self._heard_s.pop(session_id, None)
                self._signals.pop(session_id, None)

    def note_signal(self, session_id: str, signal: Mapping[str, Any]) -> None:
        """Record the current signal quality of a connected headset, as the console shows it."""
        with self._lock:
            if session_id in self._headsets:
                self._signals[session_id] = signal

    def signal(self, session_id: str) -> Mapping[str, Any] | None:
        """Return the newest signal quality; None without a headset or a measurement."""
        with self._lock:
            return self._signals.get(session_id)

    def note_frames(self, session_id: str, now_s: float) -> None:
        """Record that frames arrived on one of the session's sockets at this monotonic time."""
        self._heard_s[session_id] = now_s

    def frames_heard_s(self, session_id: str) -> float:
        """Return when frames last arrived, on any socket; minus infinity before the first."""
        return self._heard_s.get(session_id, float("-inf"))

    @property
    def any_headset_connected(self) -> bool:
        """Whether any headset's socket is open now."""
        return bool(self._headsets)

    def sessions_with_headsets(self) -> tuple[str, ...]:
        """Return the sessions with an open headset socket."""
        with self._lock:
            return tuple(self._headsets)

    def headset_can(self, session_id: str, ability: str) -> bool | None:
        """Return whether a session's headset can do something; None if none is connected."""
        with self._lock:
            abilities = self._abilities.get(session_id)
        return None if abilities is None else ability in abilities

    def headset_connected(self, session_id: str) -> bool:
        """Return whether the session has an open headset socket."""
        with self._lock:
            return session_id in self._headsets

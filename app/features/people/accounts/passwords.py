"""Hash passwords with argon2id, and reject those that are easy to guess.

As NIST SP 800-63B recommends, passwords must be long and must not be commonly used; there are no
rules about digits and symbols. How easily a password can be guessed is estimated by zxcvbn, which
knows the most common passwords, names and words, and the ways in which people vary them.

A hash takes a tenth of a second of every core and 64 MiB of memory, and anybody can trigger one by
trying to log in. So only one is computed at a time, a few callers wait, and further callers are
turned away immediately.
"""

import os
import secrets
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TypeVar

from argon2 import (
    DEFAULT_MEMORY_COST,
    DEFAULT_PARALLELISM,
    DEFAULT_TIME_COST,
    PasswordHasher,
    Type,
    extract_parameters,
)
from argon2.exceptions import InvalidHashError, VerificationError
from zxcvbn import zxcvbn

from app.errors import Busy, InvalidInput

MIN_LENGTH = 12
MAX_LENGTH = 200
MIN_DIFFERENT = 5
MIN_GUESSES = 1e10
"""The threshold above which zxcvbn calls a password "very unguessable".

For somebody who has the database and needs a tenth of a second per guess, it means thirty years.
"""
_ESTIMATED_LENGTH = 32
"""Only so many characters of a password are estimated.

zxcvbn's time grows steeply with the length: the slowest passwords of 32 characters take a few
tenths of a second, those of 72 five seconds.
"""
NICENESS = 10
MAX_COST_RATIO = 4
"""How many times our costs a stored hash may have, as releases of argon2 differ in their costs."""
Result = TypeVar("Result")
_HASHER = PasswordHasher()


@dataclass
class PasswordQueue:
    """Runs one job at a time on a low-priority thread, with at most `waiting` callers in the queue.

    Raises Busy for every further caller. Running sessions take precedence over log-in attempts, so
    the thread gives way to anything else that needs a processor.
    """

    waiting: int
    _callers: int = 0
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _worker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, "passwords", _yield_to_others)
    )

    def run(self, work: Callable[[], Result]) -> Result:
        """Wait for a turn, run `work` and return its result; raises Busy if the queue is full."""
        with self._lock:
            if self._callers > self.waiting:
                raise Busy(
                    "too many passwords are being checked at the moment",
                    remedy="Wait 2 s and try again; the password was not checked.",
                    retry_after_s=2.0,
                )
            self._callers += 1
        try:
            return self._worker.submit(work).result()
        finally:
            with self._lock:
                self._callers -= 1


def _yield_to_others() -> None:
    # Only Linux has priorities per thread; the threads that argon2 starts inherit this one's.
    if sys.platform == "linux":
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), NICENESS)


QUEUE = PasswordQueue(waiting=8)


def hash_password(password: str) -> str:
    """Return the argon2id hash of a password, with salt and costs; raises InvalidInput, Busy."""
    _require_length(password)
    return QUEUE.run(lambda: _HASHER.hash(password))


def is_password(stored: str | None, password: str) -> bool:
    """Return whether `password` matches the stored hash; takes as long if there is no hash.

    Raises InvalidInput, Busy.
    """
    _require_length(password)
    return QUEUE.run(lambda: _verified(stored or _dummy_hash(), password)) and stored is not None


def is_hash(stored: str) -> bool:
    """Return whether a stored hash is a valid argon2id hash that costs about as much as ours.

    A forged hash could demand more memory or time than the machine has.
    """
    try:
        costs = extract_parameters(stored)
    except (InvalidHashError, ValueError):
        return False
    return (
        costs.type is Type.ID
        and 0 < costs.memory_cost <= MAX_COST_RATIO * DEFAULT_MEMORY_COST
        and 0 < costs.time_cost <= MAX_COST_RATIO * DEFAULT_TIME_COST
        and 0 < costs.parallelism <= MAX_COST_RATIO * DEFAULT_PARALLELISM
        and costs.hash_len >= 16
        and costs.salt_len >= 8
    )


def _verified(stored: str, password: str) -> bool:
    try:
        return _HASHER.verify(stored, password)
    except VerificationError:
        return False


@lru_cache(maxsize=1)
def _dummy_hash() -> str:
    return _HASHER.hash(secrets.token_urlsafe(16))


def _require_length(password: str) -> None:
    if len(password) > MAX_LENGTH:
        raise InvalidInput(
            f"a password of {len(password)} characters is too long",
            valid=f"at most {MAX_LENGTH} characters",
            remedy="Choose a shorter one.",
        )


def require_good(password: str, username: str) -> None:
    """Raise InvalidInput if the password is easy to guess, without repeating it."""
    problem = None
    if len(password) < MIN_LENGTH:
        problem = f"it has {len(password)} characters"
    elif len(set(password.casefold())) < MIN_DIFFERENT:
        problem = "it repeats a few characters"
    elif username.casefold() in password.casefold() and len(password) < MIN_LENGTH + len(username):
        problem = "it consists mostly of the user name"
    elif "reembody" in password.casefold() and len(password) < MIN_LENGTH + len("reembody"):
        problem = "it consists mostly of the name of this program"
    elif _guesses(password, username) < MIN_GUESSES:
        problem = "it consists of common passwords, words, dates or patterns"
    if problem:
        raise InvalidInput(
            f"this password is too easy to guess: {problem}",
            valid=f"{MIN_LENGTH} to {MAX_LENGTH} characters, such as four or five random words",
            remedy="Choose a longer one; spaces are allowed.",
        )


def _guesses(password: str, username: str) -> float:
    beginning = password[:_ESTIMATED_LENGTH]
    return float(zxcvbn(beginning, user_inputs=[username, "reembody"])["guesses"])

"""Passwords: hashed with argon2id, long rather than complicated, never the obvious.

Length and a refusal of what others know are what NIST SP 800-63B asks of passwords; it advises
against rules about digits and signs. What others know is estimated by zxcvbn, which comes with the
commonest passwords, names and words, and knows how people vary them.

A hash takes a tenth of a second of every core and 64 MiB, and anybody may ask for one by trying to
log in. So one is made at a time, a few wait, and whoever comes then is turned away at once.
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
FEWEST_GUESSES = 1e10
"""zxcvbn's own mark for "very unguessable": with the database and a tenth of a second for each
guess, thirty years."""
_ESTIMATED_LENGTH = 32
"""Its time grows steeply with the length: of 32 characters chosen to be slow, a few tenths of a
second; of 72, five seconds. A good beginning is enough."""
NICENESS = 10
MOST_TIMES_OURS = 4
"""How much dearer a stored hash may be: releases of the library have had other costs."""
Result = TypeVar("Result")
_HASHER = PasswordHasher()


@dataclass
class Desk:
    """Does one piece of work at a time and lets `waiting` wait; raises Busy for everybody else.

    It yields to whatever else wants a processor: sessions that run come before those who knock.
    """

    waiting: int
    _here: int = 0
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _worker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, "passwords", _yield_to_others)
    )

    def do(self, work: Callable[[], Result]) -> Result:
        """The result of `work`, when its turn has come."""
        with self._lock:
            if self._here > self.waiting:
                raise Busy(
                    "too many passwords are being checked at this moment",
                    remedy="Wait 2 s and try again; the password was not looked at.",
                    retry_after_s=2.0,
                )
            self._here += 1
        try:
            return self._worker.submit(work).result()
        finally:
            with self._lock:
                self._here -= 1


def _yield_to_others() -> None:
    # Only Linux knows priorities of threads; those that argon2 begins have that of this one.
    if sys.platform == "linux":
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), NICENESS)


DESK = Desk(waiting=8)


def hash_password(password: str) -> str:
    """The argon2id hash with its salt and costs; raises InvalidInput, Busy."""
    _require_length(password)
    return DESK.do(lambda: _HASHER.hash(password))


def is_password(stored: str | None, password: str) -> bool:
    """Whether `password` belongs to the stored hash; takes as long where there is none.

    Raises InvalidInput, Busy.
    """
    _require_length(password)
    return DESK.do(lambda: _verified(stored or _nobody(), password)) and stored is not None


def is_hash(stored: str) -> bool:
    """Whether a stored hash is one that a log-in can be checked against, at a cost like ours.

    A made-up one could ask for more memory or time than the machine has.
    """
    try:
        costs = extract_parameters(stored)
    except (InvalidHashError, ValueError):
        return False
    return (
        costs.type is Type.ID
        and 0 < costs.memory_cost <= MOST_TIMES_OURS * DEFAULT_MEMORY_COST
        and 0 < costs.time_cost <= MOST_TIMES_OURS * DEFAULT_TIME_COST
        and 0 < costs.parallelism <= MOST_TIMES_OURS * DEFAULT_PARALLELISM
        and costs.hash_len >= 16
        and costs.salt_len >= 8
    )


def _verified(stored: str, password: str) -> bool:
    try:
        return _HASHER.verify(stored, password)
    except VerificationError:
        return False


@lru_cache(maxsize=1)
def _nobody() -> str:
    return _HASHER.hash(secrets.token_urlsafe(16))


def _require_length(password: str) -> None:
    if len(password) > MAX_LENGTH:
        raise InvalidInput(
            f"a password of {len(password)} characters is too long",
            valid=f"at most {MAX_LENGTH} characters",
            remedy="Choose a shorter one.",
        )


def require_good(password: str, username: str) -> None:
    """Raise InvalidInput, without repeating the password, where it would be guessed soon."""
    problem = None
    if len(password) < MIN_LENGTH:
        problem = f"it has {len(password)} characters"
    elif len(set(password.casefold())) < MIN_DIFFERENT:
        problem = "it repeats a few characters"
    elif username.casefold() in password.casefold() and len(password) < MIN_LENGTH + len(username):
        problem = "it is mostly the user name"
    elif "reembody" in password.casefold() and len(password) < MIN_LENGTH + len("reembody"):
        problem = "it is mostly the name of this program"
    elif _guesses(password, username) < FEWEST_GUESSES:
        problem = "it is made of common passwords, words, dates or patterns"
    if problem:
        raise InvalidInput(
            f"this password is too easy to guess: {problem}",
            valid=f"{MIN_LENGTH} to {MAX_LENGTH} characters, such as four or five random words",
            remedy="Choose a longer one; spaces are welcome.",
        )


def _guesses(password: str, username: str) -> float:
    beginning = password[:_ESTIMATED_LENGTH]
    return float(zxcvbn(beginning, user_inputs=[username, "reembody"])["guesses"])

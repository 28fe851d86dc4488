"""Tests of passwords: which are accepted, and how many are hashed at a time."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from argon2 import PasswordHasher

from app.errors import Busy, InvalidInput
from app.features.people.accounts import passwords
from app.features.people.accounts.passwords import (
    MAX_LENGTH,
    PasswordQueue,
    hash_password,
    is_hash,
    is_password,
    require_good,
)


@pytest.mark.parametrize(
    "password",
    [
        "password1234",
        "Password123456!",
        "P@ssw0rd1234",
        "qwertyuiop123",
        "1q2w3e4r5t6y",
        "iloveyou1234",
        "letmeinletmein",
        "Passwort2024!",
        "hallo123456789",
        "1234567890123",
        "abcdefghijklm",
        "qwertzuiopasdf",
        "123456789abc",
        "administrator1",
        "correctpassword",
    ],
)
def test_common_passwords_are_refused(password: str) -> None:
    """Common passwords and their variations are refused, and the error does not repeat them."""
    with pytest.raises(InvalidInput) as refused:
        require_good(password, "mara")
    assert password not in str(refused.value.as_json())


@pytest.mark.parametrize(
    "password",
    [
        "correct horse battery",
        "blauer Stuhl am Fenster",
        "kR7#vq2Lx9!w",
        "vier Worte die passen",
        "longer than that one",
    ],
)
def test_uncommon_phrases_and_random_passwords_are_accepted(password: str) -> None:
    """A few uncommon words, or random characters, are accepted as a password."""
    require_good(password, "mara")


def test_an_estimate_of_a_long_password_does_not_take_long() -> None:
    """A password of maximum length that is slow to estimate is still accepted."""
    slow = "4@8({[<369&#!1/|0$5+7%2" * 8
    require_good(slow[:MAX_LENGTH], "mara")


def test_too_long_a_password_is_not_hashed() -> None:
    """A password above the maximum length is refused by both hashing and verification."""
    for work in (hash_password, lambda password: is_password(None, password)):
        with pytest.raises(InvalidInput, match="201 characters"):
            work("x" * (MAX_LENGTH + 1))


def test_passwords_are_hashed_one_at_a_time() -> None:
    """Passwords are hashed one at a time; a full queue answers 503 with a retry time."""
    queue, started, go_on = PasswordQueue(waiting=2), threading.Event(), threading.Event()
    running = [0]
    most = [0]

    def work() -> bool:
        running[0] += 1
        most[0] = max(most[0], running[0])
        started.set()
        go_on.wait(30)
        running[0] -= 1
        return True

    with ThreadPoolExecutor(3) as pool:
        done = [pool.submit(queue.run, work) for _ in range(3)]
        assert started.wait(30)
        while queue._callers < 3:
            time.sleep(0.001)
        with pytest.raises(Busy) as refused:
            queue.run(work)
        go_on.set()
        assert all(one.result(30) for one in done)
    assert refused.value.status == 503
    assert refused.value.retry_after_s
    assert most[0] == 1
    assert queue.run(lambda: "free again") == "free again"


def test_failed_work_frees_its_place_in_the_queue() -> None:
    """Work that raises an error frees its place in the password queue."""
    queue = PasswordQueue(waiting=0)

    def fail() -> None:
        raise ValueError("as it may")

    for _ in range(3):
        with pytest.raises(ValueError, match="as it may"):
            queue.run(fail)


def test_a_hash_is_recognised_whatever_its_cost_parameters(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A hash with other cost parameters is recognised, unless its cost is excessive."""
    theirs = PasswordHasher().hash("correct horse battery")
    monkeypatch.setattr(passwords, "_HASHER", PasswordHasher(1, 64, 1))
    assert is_hash(theirs)
    assert is_hash(hash_password("correct horse battery"))
    assert not is_hash(theirs.replace("m=", "m=99"))

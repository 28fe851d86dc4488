"""Passwords: which may be chosen, and how many are looked at together."""

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
def test_what_everybody_tries_first_is_refused(password: str) -> None:
    """Common passwords, their variations, rows of keys and dates; and the answer repeats none."""
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
def test_a_few_words_are_enough(password: str) -> None:
    """Words in a row of one's own, or random characters."""
    require_good(password, "mara")


def test_an_estimate_of_a_long_password_does_not_take_long() -> None:
    """The slowest password that may be sent is estimated like a shorter one."""
    slow = "4@8({[<369&#!1/|0$5+7%2" * 8
    require_good(slow[:MAX_LENGTH], "mara")


def test_too_long_a_password_is_not_hashed() -> None:
    """Whoever calls: the length is bounded where the work is done."""
    for work in (hash_password, lambda password: is_password(None, password)):
        with pytest.raises(InvalidInput, match="201 characters"):
            work("x" * (MAX_LENGTH + 1))


def test_passwords_are_looked_at_one_at_a_time() -> None:
    """One is worked on, some wait, and everybody else is told at once to come again."""
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


def test_what_fails_leaves_its_place() -> None:
    """An error does not hold a turn for ever."""
    queue = PasswordQueue(waiting=0)

    def fail() -> None:
        raise ValueError("as it may")

    for _ in range(3):
        with pytest.raises(ValueError, match="as it may"):
            queue.run(fail)


def test_what_is_a_hash_does_not_hang_on_what_hashes_cost_here(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A backup of a lab is restored where passwords are made cheaply, too; a dear one nowhere."""
    theirs = PasswordHasher().hash("correct horse battery")
    monkeypatch.setattr(passwords, "_HASHER", PasswordHasher(1, 64, 1))
    assert is_hash(theirs)
    assert is_hash(hash_password("correct horse battery"))
    assert not is_hash(theirs.replace("m=", "m=99"))

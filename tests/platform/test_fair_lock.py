"""Tests of the writers' lock: first come, first served, skipping those that gave up."""

import threading
import time

from app.database import FairLock


def test_the_lock_goes_to_the_longest_waiting_thread() -> None:
    """Waiting threads get the lock in the order in which they came."""
    lock, served = FairLock(), []

    def serve(number: int) -> None:
        with lock:
            served.append(number)

    lock.acquire()
    threads = [threading.Thread(target=serve, args=(number,)) for number in range(5)]
    for count, thread in enumerate(threads, start=1):
        thread.start()
        while len(lock._waiting) < count:
            time.sleep(0.001)
    lock.release()
    for thread in threads:
        thread.join()
    assert served == [0, 1, 2, 3, 4]


def test_a_wait_that_timed_out_does_not_get_the_lock() -> None:
    """A wait that timed out does not take the lock when it is released."""
    lock = FairLock()
    lock.acquire()
    assert not lock.acquire(timeout=0.01)
    lock.release()
    assert lock.acquire(timeout=0.0)
    lock.release()

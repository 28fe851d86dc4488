"""The lock of writers: first come, first served, and whoever gave up is passed over."""

import threading
import time

from app.database import FairLock


def test_turns_go_to_whoever_waits_longest() -> None:
    """Five threads that came one after the other are served in that order."""
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


def test_whoever_gave_up_does_not_get_it() -> None:
    """A wait that ends without the lock leaves it to the others."""
    lock = FairLock()
    lock.acquire()
    assert not lock.acquire(timeout=0.01)
    lock.release()
    assert lock.acquire(timeout=0.0)
    lock.release()

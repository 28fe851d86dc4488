"""Tests of two operators who press the same button at the same moment."""

import threading
import uuid
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import pytest
from httpx2 import Response

from tests.faults.figures import note
from tests.features.lab import Json, Lab

SHORT, LONG = 60, 1000


def press_together(lab: Lab, view: Json, pool: ThreadPoolExecutor) -> list[Response]:
    """Send two start commands simultaneously, both based on the same view."""
    together = threading.Barrier(2)

    def press(_: int) -> Response:
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": view["version"],
            "type": "start",
        }
        together.wait()
        return lab.operator.post(f"/api/sessions/{view['id']}/commands", json=body)

    return list(pool.map(press, range(2)))


def press_many_times(lab: Lab, times: int) -> Counter[str]:
    """Count sessions that started twice or not at all, or did not inform the losing operator."""
    found: Counter[str] = Counter()
    with ThreadPoolExecutor(2) as pool:
        for _ in range(times):
            view = lab.join(kind="test")
            answers = press_together(lab, view, pool)
            won = [answer for answer in answers if answer.is_success]
            lost = [answer.json()["error"] for answer in answers if answer.status_code == 409]
            starts = [one for one in lab.events(view["id"]) if one["type"] == "session_started"]
            found["double"] += len(starts) > 1 or len(won) > 1
            found["none"] += len(starts) == 0 or len(won) == 0
            told = [[seen["type"] for seen in error["details"]] for error in lost]
            found["unseen"] += told != [["session_started"]]
    return found


def test_one_of_two_simultaneous_starts_succeeds(lab: Lab) -> None:
    """Of two simultaneous starts one succeeds, and the other's response names the first."""
    found = press_many_times(lab, SHORT)
    note(25, f"two operators press start (x{SHORT})", "double starts", found["double"])
    note(25, f"two operators press start (x{SHORT})", "losers not told", found["unseen"])
    assert found == Counter(double=0, none=0, unseen=0)


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_thousand_simultaneous_starts_each_succeed_once(lab: Lab) -> None:
    """A thousand pairs of simultaneous starts each start the session exactly once."""
    found = press_many_times(lab, LONG)
    note(25, f"two operators press start (x{LONG})", "double starts", found["double"])
    assert found == Counter(double=0, none=0, unseen=0)

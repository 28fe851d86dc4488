"""Two operators press the same button at the same moment."""

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
    """Both decide on the same view and press start at once."""
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
    """How often a session was started twice, not at all, or the loser was not told who won."""
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


def test_one_of_two_operators_wins_and_the_other_sees_it(lab: Lab) -> None:
    """The session starts once; who came second is told what happened and by whom."""
    found = press_many_times(lab, SHORT)
    note(25, f"two operators press start (x{SHORT})", "double starts", found["double"])
    note(25, f"two operators press start (x{SHORT})", "losers not told", found["unseen"])
    assert found == Counter(double=0, none=0, unseen=0)


@pytest.mark.long
@pytest.mark.timeout(900)
def test_one_of_two_operators_wins_a_thousand_times(lab: Lab) -> None:
    """The long form."""
    found = press_many_times(lab, LONG)
    note(25, f"two operators press start (x{LONG})", "double starts", found["double"])
    assert found == Counter(double=0, none=0, unseen=0)

"""Simulate tablets: `python -m tests.benchmarks.session_desk.submitting`.

Reads the plan as JSON from standard input and prints how long every submission took, and the total.
A tablet sends a form, gets the next one, and so on. A room full of people does that without a pause
only in the worst second of the day.
"""

import asyncio
import json
import sys
import time
import uuid
from dataclasses import asdict, dataclass
from typing import Any, Literal

import uvloop

from tests.benchmarks.session_desk.lean_http import Answer, LeanHttp

OK, MOVED = 200, (302, 303, 307)


@dataclass(frozen=True)
class Plan:
    """The plan of a run: the tablets and the forms that they submit.

    `who`: a tablet's cookie header (ours), or a participant's first path (oTree). `thinking_s`: how
    long people take for a form; 0 if they send without a pause.
    """

    server: Literal["ours", "otree"]
    port: int
    who: tuple[str, ...]
    forms: int
    items: int
    thinking_s: float = 0.0

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


@dataclass(frozen=True)
class Submitted:
    """The seconds of each submission (sent to answered), in total, and of server processor time."""

    submits_s: tuple[float, ...]
    total_s: float
    cpu_s: float = 0.0


class Refused(RuntimeError):
    """Raised if the server rejected a submission."""


async def our_tablet(plan: Plan, cookie: str) -> list[float]:
    """Submit forms as the product's page does: every answer to a form has the next one."""
    http, took_s = LeanHttp(plan.port, {"cookie": cookie}), []
    state = json.loads(_good(await http.ask("GET", "/api/tablet/state"), OK).body)
    # People who think do not finish in the same instant: one after the other begins.
    await asyncio.sleep(plan.thinking_s * plan.who.index(cookie) / len(plan.who))
    for _ in range(plan.forms):
        await asyncio.sleep(plan.thinking_s)
        body = json.dumps(_answers(state["administration"])).encode()
        began_s = time.perf_counter()
        answer = await http.ask("POST", "/api/tablet/submissions", body)
        took_s.append(time.perf_counter() - began_s)
        state = json.loads(_good(answer, OK).body)["state"]
    await http.close()
    return took_s


async def otree_browser(plan: Plan, path: str) -> list[float]:
    """Submit oTree's forms as a browser does: fetch the page, read its fields, and send them."""
    http, took_s = LeanHttp(plan.port), []
    path = _good(await http.ask("GET", path), *MOVED).headers["location"]
    fields = "&".join(f"q{number}={1 + number % 7}" for number in range(1, plan.items + 1))
    for _ in range(plan.forms):
        _good(await http.ask("GET", path), OK)
        began_s = time.perf_counter()
        answer = await http.ask("POST", path, fields.encode(), "application/x-www-form-urlencoded")
        took_s.append(time.perf_counter() - began_s)
        path = _good(answer, *MOVED).headers["location"]
    await http.close()
    return took_s


def _answers(administration: dict[str, Any]) -> dict[str, Any]:
    items = administration["instrument"]["items"]
    rated = {item["key"]: 1 + at % 7 for at, item in enumerate(items) if item["type"] == "likert"}
    open_ones = {item["key"]: None for item in items if item["type"] != "likert"}
    return {
        "idempotency_key": uuid.uuid4().hex,
        "administration": administration["key"],
        "answers": rated | open_ones,
        "shown_order": administration["item_order"],
        "seed": administration["seed"],
        "language": administration["language"],
        "timings": dict.fromkeys(rated, 1.5),
    }


def _good(answer: Answer, *expected: int) -> Answer:
    if answer.status not in expected:
        raise Refused(f"status {answer.status}: {answer.body[:500]!r}")
    return answer


async def run(plan: Plan) -> Submitted:
    """Run all tablets in parallel."""
    fill_in = our_tablet if plan.server == "ours" else otree_browser
    began_s = time.perf_counter()
    found = await asyncio.gather(*(fill_in(plan, one) for one in plan.who))
    total_s = time.perf_counter() - began_s
    return Submitted(tuple(took_s for one in found for took_s in one), total_s)


def main() -> None:
    """Read the plan from standard input and run it."""
    read: dict[str, Any] = json.loads(sys.stdin.readline())
    plan = Plan(**{**read, "who": tuple(read["who"])})
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        print(json.dumps(asdict(runner.run(run(plan)))), flush=True)


if __name__ == "__main__":
    main()

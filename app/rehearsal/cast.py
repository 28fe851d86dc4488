"""Who plays a session: an operator who presses buttons, a tablet that answers, a headset."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from app.client import Operator, ServerRefusedError, Tablet
from app.rehearsal.answers import agreement, fill_in
from app.rehearsal.body import Person
from app.rehearsal.headset import Headset

Json = dict[str, Any]
ENDED = ("completed", "aborted", "withdrawn")
OVERTAKEN = ("stale", "not_now")
"""What the server says where somebody else, or the headset, was first."""
LOOK_EVERY_S = 0.1


@dataclass
class Cast:
    """The three devices and what they share."""

    operator: Operator
    tablet: Tablet
    headset: Headset
    person: Person
    rng: np.random.Generator
    say: Callable[[str], None] = lambda _: None
    submitted: set[str] = field(default_factory=set)


async def perform(cast: Cast) -> None:
    """All three at once, until the session is over; the first that fails ends the others."""
    async with asyncio.TaskGroup() as group:
        group.create_task(cast.headset.run())
        group.create_task(answer(cast))
        group.create_task(operate(cast))


async def operate(cast: Cast) -> None:
    """The operator: looks, presses the next button, looks again."""
    told = -1
    while True:
        view = await cast.operator.view()
        if view["status"] in ENDED:
            return
        current = view["current"]
        if current is not None and current["index"] != told:
            told = current["index"]
            cast.say(f"{told + 1}/{len(view['steps'])} {view['steps'][told]['title']}")
        action = _next_action(view, cast.person)
        if action is not None:
            kind, fields = action
            try:
                await cast.operator.command(view, kind, **fields)
            except ServerRefusedError as error:
                if error.code not in OVERTAKEN:
                    raise
        await asyncio.sleep(LOOK_EVERY_S)


def _next_action(view: Json, person: Person) -> tuple[str, Json] | None:
    if view["status"] == "planned":
        return "start", {}
    if view["held"] is not None:
        # A simulated participant is never unwell; that the rule works is seen all the same.
        return "override_stop", {"reason": "Rehearsal: nobody is unwell."}
    current = view["current"]
    step = view["steps"][current["index"]]
    connected = any(one["kind"] == "headset" and one["connected"] for one in view["devices"])
    match step["kind"]:
        case "height":
            height = {"stated": round(person.stature_m, 2), "matched": round(person.stature_m, 3)}
            return "complete_step", {"height_m": height}
        case "debrief":
            return "complete_step", {}
        case "free_roam" | "practice" | "task":
            if current["status"] == "ready" and connected:
                return "begin_phase", {}
            if current["status"] == "paused" and connected and not current["resuming"]:
                return "resume", {}
    return None


async def answer(cast: Cast) -> None:
    """The tablet: reads, agrees, answers."""
    while True:
        state = await cast.tablet.state()
        match state["screen"]:
            case "finished":
                return
            case "consent":
                await cast.tablet.consent(state["step_index"], agreement(state["consent"]))
            case "instructions":
                await cast.tablet.acknowledge(state["step_index"])
            case "form":
                await _fill_in(cast, state["administration"])
            case _:
                await asyncio.sleep(LOOK_EVERY_S)


async def _fill_in(cast: Cast, administration: Json) -> None:
    view = await cast.operator.view()
    step = view["steps"][administration["step_index"]]
    answers = fill_in(
        administration["instrument"], cast.person, step["latency_ms"], step["limb"], cast.rng
    )
    await cast.tablet.submit(administration, answers, f"rehearsal-{administration['key']}"[:64])
    cast.submitted.add(administration["key"])

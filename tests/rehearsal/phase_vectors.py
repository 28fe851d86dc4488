"""Make the vectors of phases: `python -m tests.rehearsal.phase_vectors` writes them.

`tests/vectors/phases/README.md` describes the files. They hold the headset's page to the reports
that the scripted headset makes of the same touches, orders and losses of the connection.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from app.rehearsal.task_run import BoxRun
from app.rehearsal.timed_run import FreeRun, TimedRun
from app.science.tasks import Laterality, TaskRules, current_goal
from app.wire import PhaseReport, ReportBody
from tests.rehearsal.orders import order
from tests.science.tasks.vector_files import layout

FOLDER = Path(__file__).parents[1] / "vectors" / "phases"
Json = dict[str, Any]
T = TypeVar("T")
FRAME_S = 11 / 90
"""A slow headset: the rules do not depend on the rate, and the files stay small."""

PARTS = {
    "hand": ("LeftHand", "RightHand", "RightIndexDistal", "RightLowerArm"),
    "foot": ("LeftFoot", "LeftToes", "RightFoot", "RightLowerLeg"),
}
_BECOMES = {
    "started": "running",
    "resumed": "running",
    "walk_back_started": "walk_back",
    "walk_back_ended": "running",
    "time_up": "freezing",
    "paused": "paused",
    "ended": "done",
}


@dataclass(frozen=True)
class Script:
    """What happens in one phase; times in seconds since the headset heard of it.

    `pauses`: when the operator pauses, and for how long. `losses`: when the connection is lost, and
    for how long. `restarts`: the status in which the client starts anew, and the earliest time.
    `noticed`: whether the server has noticed that before the client is back.
    """

    fact: str
    layout: str | None
    seed: int
    hand: str = "right"
    changes: Json = field(default_factory=dict)
    pauses: tuple[tuple[float, float], ...] = ()
    losses: tuple[tuple[float, float], ...] = ()
    restarts: tuple[tuple[str, float], ...] = ()
    noticed: bool = True


SCRIPTS = {
    "free": Script("A free phase has a clock and nothing to touch.", None, 1),
    "free_paused": Script(
        "An operator's pause and a broken connection stop the clock of a free phase.",
        None,
        2,
        pauses=((1.0, 0.5),),
        losses=((0.1, 0.3), (2.0, 0.4)),
        changes={"duration_s": 2.5},
    ),
    "hand": Script("Touches of the hand become contacts and completions.", "hand", 3),
    "hand_left": Script(
        "A left-handed participant pauses in contact with the boxes.",
        "hand_rim",
        4,
        hand="left",
        pauses=((2.0, 0.7), (4.0, 0.3)),
    ),
    "practice": Script(
        "A practice ends with the completion that it requires.",
        "hand",
        5,
        changes={"kind": "practice", "until_completions": 2, "duration_s": 60.0},
    ),
    "foot": Script("A foot task walks back after each completion.", "foot", 6),
    "foot_paused": Script(
        "Pauses and losses of the connection fall into walks back, too.",
        "foot_reversing",
        7,
        pauses=((2.5, 0.6), (5.0, 0.5)),
        losses=((3.6, 0.5), (6.5, 0.4)),
    ),
    "restart": Script(
        "A client that restarts continues with the order turned round and the time that is left.",
        "hand",
        8,
        restarts=(("running", 4.0),),
    ),
    "restart_unnoticed": Script(
        "A client that is back before the server has noticed its loss reports the pause itself.",
        "hand",
        9,
        restarts=(("running", 3.0), ("running", 5.0)),
        noticed=False,
    ),
    "restart_in_walk_back": Script(
        "A client that restarts in a walk back ends it and waits for the operator.",
        "foot",
        10,
        restarts=(("walk_back", 0.0), ("paused", 3.0)),
    ),
    "restart_frozen": Script(
        "A client that restarts in the freeze ends the phase and nothing else.",
        "foot",
        11,
        restarts=(("freezing", 0.0),),
        changes={"freeze_s": 1.0, "duration_s": 3.0},
    ),
}


@dataclass
class _Play:
    """One phase between a simulated participant, a headset and a server that loses nothing."""

    script: Script
    steps: list[Json] = field(default_factory=list)
    contacts: set[tuple[str, str]] = field(default_factory=set)
    t_s: float = 0.0

    def __post_init__(self) -> None:
        box = {} if self.script.layout is None else {"kind": "task", "duration_s": 8.0}
        limb = None if self.script.layout is None else self.script.layout.split("_", maxsplit=1)[0]
        self.order = order(limb=limb, **{**box, **self.script.changes})
        self.rng = np.random.default_rng(self.script.seed)
        self.parts = () if limb is None else PARTS[limb]
        self.first = self.order
        self.run = self._new_run()

    def _new_run(self) -> TimedRun:
        if self.script.layout is None:
            return FreeRun(self.order, self.t_s)
        rules = TaskRules(layout(self.script.layout), Laterality(self.script.hand))
        return BoxRun(self.order, rules, self.parts, self.t_s)

    def play(self) -> list[Json]:
        """Return the steps until the phase has ended, each with what it reported."""
        restarts = list(self.script.restarts)
        for index in range(1, 400):
            self.t_s = index * FRAME_S
            if restarts and self.t_s >= restarts[0][1] and self.order.status == restarts[0][0]:
                restarts.pop(0)
                self._restart()
            self._operate()
            if self._lost() and not self._lost(FRAME_S):
                self._tell(status="paused" if self.order.status == "running" else None)
            self._frame()
            if self.run.ended:
                return self.steps
        raise AssertionError(f"{self.script.fact} does not end")

    def _restart(self) -> None:
        if self.script.noticed and self.order.status == "running":
            self.order = self.order.model_copy(update={"status": "paused"})
        self.contacts.clear()
        self.run = self._new_run()
        self.steps.append({"t_s": self.t_s, "restart": self._changed()})

    def _operate(self) -> None:
        """Pause, and resume whatever is paused, as a patient operator would."""
        for since_s, lasts_s in self.script.pauses:
            if since_s <= self.t_s < since_s + FRAME_S and self.order.status == "running":
                self._tell(pausing=True)
            if since_s <= self.t_s < since_s + lasts_s:
                return
        if self._lost():
            return
        if self.rng.random() < 0.3:
            self._tell(resuming=self.order.status == "paused")

    def _tell(self, *, status: str | None = None, **requests: bool) -> None:
        """Give the run the server's newest state, and apply what it reports."""
        update: Json = {"pausing": False, "resuming": False, **requests}
        if status is not None:
            update["status"] = status
        self.order = self.order.model_copy(update=update)
        step: Json = {"t_s": self.t_s, "order": self._changed()}
        self._record(step, self.run.follow(self.order, self.t_s))

    def _changed(self) -> Json:
        """Return the fields of the order that differ from the first one."""
        first = self.first.model_dump(mode="json")
        now = self.order.model_dump(mode="json")
        return {name: value for name, value in now.items() if first[name] != value}

    def _lost(self, later_s: float = 0.0) -> bool:
        t_s = self.t_s + later_s
        return any(since <= t_s < since + lasts for since, lasts in self.script.losses)

    def _frame(self) -> None:
        self._move()
        surfaces = self._surfaces()
        near = {pair for pair in sorted(self.contacts) if self.rng.random() < 0.8}
        kept = self.rng.random() < 0.2
        touched = {pair for pair in self.contacts if not (kept and pair in near)}
        tables = [
            np.array(
                [[(key, part) in pairs for part in self.parts] for key in surfaces], dtype=np.bool_
            ).reshape(len(surfaces), len(self.parts))
            for pairs in (touched, near | touched)
        ]
        lost = self._lost()
        step: Json = {"t_s": self.t_s, "touched": sorted(touched)}
        if near - touched:
            step["near"] = sorted(near - touched)
        if lost:
            step["connected"] = False
        reports = self.run.frame(self.t_s, lambda: (tables[0], tables[1]), connected=not lost)
        self._record(step, reports)

    def _surfaces(self) -> tuple[str, ...]:
        if not isinstance(self.run, BoxRun):
            return ()
        return tuple(surface.key for surface in self.run.state.rules.layout.surfaces)

    def _move(self) -> None:
        """Let go of a surface, touch the goal or too early the target, or hit something else."""
        if not isinstance(self.run, BoxRun):
            return
        goal, draw = current_goal(self.run.state), self.rng.random()
        if self.contacts and draw < 0.5:
            self.contacts.discard(self._one_of(sorted(self.contacts)))
        elif goal is not None and draw < 0.88:
            self.contacts.add((goal, self._one_of(sorted(self._counting()))))
        elif draw < 0.92:
            target = self.run.state.rules.layout.target_key
            self.contacts.add((target, self._one_of(sorted(self._counting()))))
        else:
            self.contacts.add((self._one_of(self._surfaces()), self._one_of(self.parts)))

    def _one_of(self, choices: Sequence[T]) -> T:
        return choices[int(self.rng.integers(len(choices)))]

    def _counting(self) -> frozenset[str]:
        assert isinstance(self.run, BoxRun)
        return self.run.state.rules.counting_parts & frozenset(self.parts)

    def _record(self, step: Json, reports: list[ReportBody]) -> None:
        if reports:
            step = {**step, "reports": [one.model_dump(mode="json") for one in reports]}
        self.steps.append(step)
        for one in reports:
            if isinstance(one, PhaseReport):
                update: Json = {"status": _BECOMES[one.what], "active_s": one.active_s}
                update |= {"pausing": False} if one.what == "paused" else {}
                update |= {"resuming": False} if one.what == "resumed" else {}
                self.order = self.order.model_copy(update=update)
            elif one.kind == "completion":
                self.order = self.order.model_copy(update={"completions": one.number})


def make_all() -> dict[str, Json]:
    """Return the contents of every file by its name."""
    return {name: _vector(script) for name, script in SCRIPTS.items()}


def _vector(script: Script) -> Json:
    play = _Play(script)
    return {
        "kind": "phase",
        "fact": script.fact,
        "layout": script.layout,
        "writing_hand": script.hand,
        "parts": play.parts,
        "order": play.first.model_dump(mode="json"),
        "steps": play.play(),
    }


def as_text(vector: Json) -> str:
    """Return a vector as JSON with one step per line."""
    head = {key: value for key, value in vector.items() if key != "steps"}
    steps = ",\n".join(json.dumps(step) for step in vector["steps"])
    return json.dumps(head)[:-1] + f', "steps": [\n{steps}\n]}}\n'


def stored() -> Iterator[tuple[str, Json]]:
    """Return every stored vector with its name."""
    for path in sorted(FOLDER.glob("*.json")):
        yield path.stem, json.loads(path.read_text())


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, vector in make_all().items():
        (FOLDER / f"{name}.json").write_text(as_text(vector))

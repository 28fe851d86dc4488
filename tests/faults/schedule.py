"""Draw when to kill the server: in every kind of step, at moments drawn from a seed.

A target names a place in the procedure (`step`) and what must be happening there (`kind`); the kill
comes a random time after that was observed. Targets of one session are in the order of its
procedure.
"""

from dataclasses import dataclass

import numpy as np

from app.wire.messages import HeadsetState

SETUP_STEPS, FREE_ROAM, FIRST_TASK, TASKS = 5, 5, 6, 6
KILLS_PER_SESSION = 20
SHORT_WAIT_S, LONGEST_WAIT_S = 0.03, {"setup": 0.2, "free_roam": 0.6, "running": 0.6}
HAND = ("preparing", "running", "paused", "freezing", "questionnaire")
FOOT = ("preparing", "running", "paused", "walk_back", "freezing", "questionnaire")
KINDS = ("setup", "free_roam", *FOOT)


@dataclass(frozen=True)
class Target:
    """A kill that comes `wait_s` after `kind` was observed at step `step`.

    Steps of the procedure count from 0; the set-up counts as one place.
    """

    step: int
    kind: str
    wait_s: float


def kind_of(step: int | None, step_kind: str | None, phase_status: str | None) -> str:
    """Return the kind of activity at a step, in the terms of the schedule."""
    if step_kind == "task":
        return phase_status or "ready"
    if step_kind in ("questionnaire", "free_roam", "debrief"):
        return step_kind
    return "setup" if step is None or step <= SETUP_STEPS else "ready"


def seen(state: HeadsetState | None) -> tuple[int, str]:
    """Return the step at which the headset currently is, and its kind."""
    if state is None:
        return 0, "setup"
    status = None if state.phase is None else state.phase.status
    return state.step_index or 0, kind_of(state.step_index, state.step_kind, status)


def draw_schedule(rng: np.random.Generator) -> list[Target]:
    """Draw more targets than KILLS_PER_SESSION: a short step may end before it is observed."""
    targets = [_target(SETUP_STEPS - 1, "setup", rng) for _ in range(3)]
    targets += [_target(FREE_ROAM, "free_roam", rng) for _ in range(2)]
    for task in range(TASKS):
        kinds = HAND if task % 2 == 0 else FOOT
        chosen = sorted(int(at) for at in rng.choice(len(kinds), size=3, replace=False))
        step = FIRST_TASK + 2 * task
        for kind in _possible([kinds[at] for at in chosen]):
            targets.append(_target(step + (kind == "questionnaire"), kind, rng))
    return targets


def _possible(kinds: list[str]) -> list[str]:
    """Add a kill while running before a kill while paused: only that kill pauses the phase."""
    if "paused" in kinds and "running" not in kinds:
        kinds.insert(kinds.index("paused"), "running")
    return kinds


def _target(step: int, kind: str, rng: np.random.Generator) -> Target:
    longest_s = LONGEST_WAIT_S.get(kind, SHORT_WAIT_S)
    return Target(step, kind, float(rng.uniform(0.0, longest_s)))

"""Notice that the headset no longer measures the feet during a phase in which they act."""

from collections.abc import Iterator
from dataclasses import dataclass

from app.features.record.alarms.alarm import Condition
from app.wire import Goal, GoalsReport, HeadsetState

_FEET: tuple[Goal, Goal] = ("LeftLowerLeg", "RightLowerLeg")
_IN_PROGRESS = ("preparing", "running", "paused", "walk_back")


@dataclass
class FeetWatch:
    """Compares the newest report of the goals with the phase; a client without one is trusted."""

    goals: GoalsReport | None = None
    _is_foot_phase: bool = False

    def update_state(self, state: HeadsetState) -> None:
        """Apply a new state of the session."""
        phase = state.phase
        self._is_foot_phase = (
            phase is not None and phase.limb == "foot" and phase.status in _IN_PROGRESS
        )

    def check(self) -> Iterator[Condition]:
        """Yield a condition while a foot that acts is not measured."""
        if self.goals is None or not self._is_foot_phase:
            return
        parts = [goal for goal in _FEET if self.goals.states[goal] != "tracked"]
        if parts:
            states = ", ".join(f"{part} {self.goals.states[part]}" for part in parts)
            message = f"the headset does not measure the feet: {states}"
            yield Condition(
                "feet_untracked",
                message,
                client_t_s=self.goals.t_s,
                joints=tuple(parts),
            )

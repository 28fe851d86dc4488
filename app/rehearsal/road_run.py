"""A phase on the road: where the participant is at each step, when they go, and what is reported.

The scripted participant walks to the kerb, looks, and goes as soon as no car would reach their line
within `accepts_s` at its present speed; a car that stands gives way. That rule is an assumption of
ours, as for the walkers of scenes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, hypot, pi

from app.rehearsal.timed_run import FreeRun
from app.science.cosimulation import State, arrival_s
from app.science.simulation import Goal, GoalKind
from app.wire import CompletionReport, FloorPlace, PhaseOrder, ReportBody, RoadActor

BODY_M = 0.5
WAITS_M = 0.4
"""How far behind the kerb the participant stops to look."""
LOOKS_S = 1.0
ACROSS_M = 0.3
"""Somebody who is this far behind the other kerb is across."""
NEAR_M = 0.2
LIFT_M = 0.1
_STANDING_M_S = 0.05


@dataclass(frozen=True)
class RoadShape:
    """What a headset knows of the road: from the start square to the kerb, and across.

    Attributes:
        lane_width_m: of each of two lanes.
        starts_behind_kerb_m: from the middle of the start square to the near kerb.
        step_s: of the scene.
        kerb_height_m: how far the carriageway lies below the pavement.
    """

    lane_width_m: float
    starts_behind_kerb_m: float
    step_s: float
    kerb_height_m: float

    def y_m(self, z_m: float) -> float:
        """Return where somebody in the room is across the road."""
        return -z_m - self.lane_width_m - self.starts_behind_kerb_m

    def z_m(self, y_m: float) -> float:
        """Return where a place across the road is in the room."""
        return -y_m - self.lane_width_m - self.starts_behind_kerb_m

    def side(self, y_m: float) -> int:
        """Return -1 on the near side, 1 on the other, 0 in between."""
        if abs(y_m) < self.lane_width_m + ACROSS_M:
            return 0
        return 1 if y_m > 0.0 else -1


class CrossingRun(FreeRun):
    """One phase on the road: the active clock, the participant's places, crossings done."""

    def __init__(self, order: PhaseOrder, road: RoadShape, accepts_s: float, t_s: float) -> None:
        super().__init__(order, t_s)
        self.road, self._accepts_s = road, accepts_s
        self.begins_at_s = order.active_s
        self._done = order.completions
        self._reported = order.completions
        self._side: int | None = None
        self._since_s = order.active_s
        self._last: tuple[float, float, float] | None = None
        self._heading_rad = pi / 2.0
        self._next_step = 0
        self._looks_from_s: float | None = None
        self._goes_to: int | None = None
        self._news: list[ReportBody] = []

    @property
    def ends_early(self) -> bool:
        """Whether as many crossings are done as the study asks for."""
        required = self.order.until_completions
        return required is not None and self.clock_runs and self._reported >= required

    def stands_at(self, x_m: float, z_m: float) -> FloorPlace:
        """Return a place of somebody who stands, facing across."""
        return (x_m, self.road.y_m(z_m), self._heading_rad, 0.0)

    def walk(self, t_s: float, x_m: float, z_m: float) -> list[FloorPlace]:
        """Take where the participant is in a frame; return the places of the steps until then."""
        y_m = self.road.y_m(z_m)
        if self._last is None or not self.clock_runs:
            # While the clock stands people may walk; the next step begins where they are then.
            self._last = (self.active_s(t_s), x_m, y_m)
            self._side = self._side or self.road.side(y_m)
            return self._first(x_m, y_m) if self.clock_runs else []
        found = self._places(self.active_s(t_s), x_m, y_m)
        side = self.road.side(y_m)
        if side and self._side and side != self._side:
            self._cross(t_s)
        self._side = side or self._side
        return found

    def goal(self, actors: Sequence[RoadActor]) -> Goal | None:
        """Return where the participant walks; None before the clock has started."""
        if not self.clock_runs or self._last is None:
            return None
        active_s, x_m, y_m = self._last
        side = self._side or -1
        kerb_m = self.road.lane_width_m
        if self._goes_to is not None and self._goes_to == side:
            self._goes_to = self._looks_from_s = None
        if self._goes_to is None:
            if abs(y_m) > kerb_m + WAITS_M + NEAR_M:
                return self._to(side * (kerb_m + WAITS_M))
            if self._looks_from_s is None:
                self._looks_from_s = active_s
            gap_s = min((arrival_s(_state(one), x_m, BODY_M / 2.0) for one in actors
                         if one.kind == "car"), default=float("inf"))  # fmt: skip
            if active_s - self._looks_from_s < LOOKS_S or gap_s < self._accepts_s:
                return self._to(side * (kerb_m + WAITS_M))
            self._goes_to = -side
        return self._to(self._goes_to * (kerb_m + self.road.starts_behind_kerb_m))

    def news(self, _t_s: float) -> list[ReportBody]:
        """Return reports of crossings done since the last call."""
        news, self._news = self._news, []
        self._reported += len(news)
        return news

    def _to(self, y_m: float) -> Goal:
        target = (0.0, 0.0, self.road.z_m(y_m))
        return Goal(GoalKind.WALK_TO, None, target, NEAR_M, (0.0, LIFT_M, 0.0))

    def _first(self, x_m: float, y_m: float) -> list[FloorPlace]:
        if self._next_step:
            return []
        self._next_step = 1
        return [(x_m, y_m, self._heading_rad, 0.0)]

    def _places(self, active_s: float, x_m: float, y_m: float) -> list[FloorPlace]:
        """Return the places between the last frame and this one, interpolated."""
        assert self._last is not None  # noqa: S101 - `walk` has set it
        before_s, before_x_m, before_y_m = self._last
        self._last = (active_s, x_m, y_m)
        found = self._first(before_x_m, before_y_m)
        took_s = active_s - before_s
        if took_s <= 0.0:
            return found
        dx_m, dy_m = x_m - before_x_m, y_m - before_y_m
        speed = hypot(dx_m, dy_m) / took_s
        if speed > _STANDING_M_S:
            self._heading_rad = atan2(dy_m, dx_m)
        while (at_s := self.begins_at_s + self._next_step * self.road.step_s) <= active_s + 1e-9:
            share = (at_s - before_s) / took_s
            place = (before_x_m + share * dx_m, before_y_m + share * dy_m)
            found.append((*place, self._heading_rad, speed))
            self._next_step += 1
        return found

    def _cross(self, t_s: float) -> None:
        active_s = self.active_s(t_s)
        self._done += 1
        self._news.append(
            CompletionReport(
                phase_id=self.order.phase_id,
                number=self._done,
                t_s=t_s,
                active_s=active_s,
                duration_s=max(0.0, active_s - self._since_s),
                order=(),
                out_of_order_touches=0,
            )
        )
        self._since_s = active_s


def _state(actor: RoadActor) -> State:
    return State(time_s=0.0, **actor.model_dump())

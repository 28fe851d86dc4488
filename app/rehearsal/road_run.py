"""A phase on the road: where the participant is at each step, when they go, and what is reported.

The scripted participant walks to the kerb, looks, and goes as soon as no car would reach their line
within `accepts_s` at its present speed; a car that stands gives way. That rule is an assumption of
ours, as for the walkers of scenes.
"""

from collections.abc import Sequence
from math import atan2, hypot, pi

from app.rehearsal.road_shape import RoadShape
from app.rehearsal.timed_run import Awaited, FreeRun
from app.science.cosimulation import State, arrival_s
from app.science.simulation import Goal, GoalKind
from app.wire import CompletionReport, FloorPlace, PhaseOrder, ReportBody, RoadActor

BODY_M = 0.5
WAITS_M = 0.4
"""How far behind the kerb the participant stops to look."""
LOOKS_S = 1.0
AT_START_M = 0.5
"""Whoever is this near to the middle of the start square, on its pavement, stands on it."""
NEAR_M = 0.2
LIFT_M = 0.1
_STANDING_M_S = 0.05


class CrossingRun(FreeRun):
    """One phase on the road: the active clock, the participant's places, crossings done."""

    def __init__(self, order: PhaseOrder, road: RoadShape, accepts_s: float, t_s: float) -> None:
        super().__init__(order, t_s)
        self.road, self._accepts_s = road, accepts_s
        self.begins_at_s = order.active_s
        self._done = order.completions
        self._reported = order.completions
        self._side: int | None = None
        self._is_at_start = False
        self._has_traffic = True
        self._since_s = order.active_s
        self._last: tuple[float, float, float] | None = None
        self._heading_rad = pi / 2.0
        self._next_step = 0
        self._looks_from_s: float | None = None
        self._goes_to: int | None = None
        self._stays: Goal | None = None
        self._news: list[ReportBody] = []

    @property
    def ends_early(self) -> bool:
        """Whether as many crossings are done as the study asks for."""
        required = self.order.until_completions
        return required is not None and self.clock_runs and self._reported >= required

    @property
    def awaits(self) -> Awaited | None:
        """What the clock waits for: the start square before it starts, and always the cars."""
        if self.clock.last_s is None and not self._is_at_start:
            return "start"
        return None if self._has_traffic else "traffic"

    def follow_traffic(self, *, has_traffic: bool) -> None:
        """Say whether the scene goes on: the clock waits for it."""
        self._has_traffic = has_traffic

    def enter_scene(self, t_s: float, x_m: float, z_m: float) -> FloorPlace:
        """Count the steps of a scene that begins now; return where the participant stands."""
        self.begins_at_s = self.active_s(t_s)
        self._next_step, self._last = 0, None
        return (x_m, self.road.y_m(z_m), self._heading_rad, 0.0)

    def walk(self, t_s: float, x_m: float, z_m: float) -> list[FloorPlace]:
        """Take where the participant is in a frame; return the places of the steps until then."""
        y_m = self.road.y_m(z_m)
        is_near = hypot(x_m, z_m) <= AT_START_M
        self._is_at_start = is_near and y_m <= -self.road.lane_width_m
        if self._last is None or not self.clock_runs:
            # While the clock stands people may walk, also across; the rest begins where they are.
            self._last = (self.active_s(t_s), x_m, y_m)
            self._side = self.road.side(y_m) or self._side
            return self._first(x_m, y_m) if self.clock_runs else []
        found = self._places(self.active_s(t_s), x_m, y_m)
        side = self.road.side(y_m)
        if side and self._side and side != self._side:
            self._cross(t_s)
        self._side = side or self._side
        return found

    def goal(self, actors: Sequence[RoadActor]) -> Goal | None:
        """Return where the participant walks: to the start square before the clock starts."""
        if self._last is None or self.clock.last_s is None:
            return self._to(self.road.y_m(0.0))
        active_s, x_m, y_m = self._last
        if not self.clock_runs:
            self._stays = self._stays or self._to(y_m)
            return self._stays
        self._stays = None
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

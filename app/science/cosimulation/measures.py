"""What a crossing was like: waiting, gap accepted, safety margins, collision.

    waiting            time that a person stood within 1.5 m of the kerb before stepping onto the
                       carriageway
    gap accepted       at that step, the time until the first car would reach the person's line at
                       the speed it had: what the person could see (Oxley et al. 2005)
    gaps refused       times between successive cars at that line while the person waited
    time to collision  the smallest over the crossing, with speeds and headings kept (Hayward 1972)
    post-encroachment  time between one leaving the area that both use and the other reaching it,
                       the smallest over cars (Allen, Shin and Cooper 1978)
    collision          the outlines overlap; the person is a disc, the car a rectangle

Sources: Oxley, Ihsen, Fildes, Charlton and Day (2005), "Crossing roads safely"; Hayward (1972),
"Near-miss determination through use of a scale of danger"; Allen, Shin and Cooper (1978), "Analysis
of traffic conflicts and collisions".
"""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, hypot, inf, sin

from app.science.cosimulation.record import Record
from app.science.cosimulation.road import STOPPED_M_S, Road, arrival_s, direction_of
from app.science.cosimulation.states import State

KERB_ZONE_M = 1.5
"""Somebody who stands closer to the kerb waits to cross."""
SWAY_M = 0.15
"""Somebody who stands sways; only who is this far past a kerb's edge has stepped over it."""


@dataclass(frozen=True)
class Collision:
    """The first overlap of a person with a car: which, when, and how fast the car was."""

    car: str
    time_s: float
    car_speed_m_s: float


@dataclass(frozen=True)
class Crossing:
    """One person's crossing; a value is None where it does not exist.

    Attributes:
        person: name of the actor.
        steps_on_s, steps_off_s: stepping onto the carriageway, and behind a kerb again: the last
            times over its edge before they were clearly past it (`SWAY_M`).
        is_across: whether that was the other kerb; false if they turned back or are still on it.
        waited_s: see the module.
        gap_accepted_s: None if no car was coming, or nobody stepped onto the carriageway.
        gaps_refused_s: in the order in which the cars came.
        least_time_to_collision_s: None if no step led to a collision.
        least_post_encroachment_s: None if no car used the person's line.
        closest_m: smallest distance between the outlines while on the carriageway.
        collision: None without one.
    """

    person: str
    steps_on_s: float | None
    steps_off_s: float | None
    is_across: bool
    waited_s: float
    gap_accepted_s: float | None
    gaps_refused_s: tuple[float, ...]
    least_time_to_collision_s: float | None
    least_post_encroachment_s: float | None
    closest_m: float | None
    collision: Collision | None


Frame = tuple[State, list[State]]
"""A person and all cars at one step."""


def crossings(record: Record, road: Road) -> tuple[Crossing, ...]:
    """Return the crossing of every person of a record, by name."""
    names = {row.state.name for rows in record.steps for row in rows if row.state.kind == "person"}
    return tuple(
        _crossing(list(_frames(record, name)), road, name, record.step_s) for name in sorted(names)
    )


def crossings_of(record: Record, road: Road, name: str) -> tuple[Crossing, ...]:
    """Return the crossings of one person one after the other.

    Each begins where the one before ended, that is with the first step behind a kerb; somebody who
    turns back ends one without being across. Who only sways over a kerb's edge has done neither.
    A last one without a step onto the carriageway is left out, unless it is the only one.
    """
    found: list[Crossing] = []
    frames: list[Frame] = []
    has_stepped_on = False
    for frame in _frames(record, name):
        frames.append(frame)
        past_m = _past_kerb_m(frame[0], road)
        if has_stepped_on and past_m > SWAY_M:
            found.append(_crossing(frames, road, name, record.step_s))
            frames = [frame]
        has_stepped_on = past_m < -SWAY_M or (has_stepped_on and past_m <= SWAY_M)
    if has_stepped_on or (frames and not found):
        found.append(_crossing(frames, road, name, record.step_s))
    return tuple(found)


def _past_kerb_m(own: State, road: Road) -> float:
    """Return how far somebody is behind the nearer kerb's edge; negative on the carriageway."""
    return abs(own.y_m) - road.lane_width_m


def _stepped(frames: list[Frame], road: Road) -> tuple[int | None, int | None]:
    """Return at which frame a person stepped onto the carriageway, and at which off it again.

    These are the last times over the edge before they were clearly past it.
    """
    past_m = [_past_kerb_m(own, road) for own, _ in frames]
    ons = [at for at, past in enumerate(past_m) if past < 0.0 and (at == 0 or past_m[at - 1] >= 0)]
    if not ons:
        return None, None
    deep = next((at for at, past in enumerate(past_m) if past < -SWAY_M), None)
    on = ons[0] if deep is None else max(at for at in ons if at <= deep)
    begun = range((on if deep is None else deep) + 1, len(frames))
    gone = next((at for at in begun if past_m[at] > SWAY_M), len(frames) - 1)
    if past_m[gone] < 0.0:
        return on, None
    return on, max(at for at in range(on + 1, gone + 1) if past_m[at] >= 0.0 > past_m[at - 1])


def _crossing(frames: list[Frame], road: Road, name: str, step_s: float) -> Crossing:
    on, off = _stepped(frames, road)
    before = frames[: len(frames) if on is None else on]
    waits = [
        abs(own.y_m) <= road.lane_width_m + KERB_ZONE_M and own.speed_m_s < STOPPED_M_S
        for own, _ in before
    ]
    crossed = [] if on is None else frames[on : None if off is None else off + 1]
    gap = inf
    if on is not None:
        own, cars = frames[on]
        gap = min((arrival_s(car, own.x_m, own.width_m / 2.0) for car in cars), default=inf)
    refused = _refused([frame for frame, waited in zip(before, waits, strict=True) if waited])
    reach = [_time_to_collision_s(own, car) for own, cars in crossed for car in cars]
    near = [(own, car, _free_m(own, car)) for own, cars in crossed for car in cars]
    hit = next(((own, car) for own, car, free_m in near if free_m <= 0.0), None)
    margins = [] if on is None else list(_post_encroachments_s(frames, crossed))
    return Crossing(
        person=name,
        steps_on_s=None if on is None else frames[on][0].time_s,
        steps_off_s=None if off is None else frames[off][0].time_s,
        is_across=off is not None and frames[off][0].y_m * frames[0][0].y_m < 0.0,
        waited_s=round(sum(waits) * step_s, 6),
        gap_accepted_s=_finite(gap),
        gaps_refused_s=refused,
        least_time_to_collision_s=_finite(min(reach, default=inf)),
        least_post_encroachment_s=_finite(min(margins, default=inf)),
        closest_m=_finite(min((max(0.0, free_m) for _, _, free_m in near), default=inf)),
        collision=None if hit is None else Collision(hit[1].name, hit[0].time_s, hit[1].speed_m_s),
    )


def _frames(record: Record, name: str) -> Iterator[Frame]:
    """Yield the person and all cars at each step at which the person is there."""
    for rows in record.steps:
        own = [row.state for row in rows if row.state.name == name]
        if own:
            yield own[0], [row.state for row in rows if row.state.kind == "car"]


def _refused(waiting: list[tuple[State, list[State]]]) -> tuple[float, ...]:
    """Return the times between the cars whose fronts passed a person who waited."""
    passed_s: list[float] = []
    ahead: dict[str, bool] = {}
    for own, cars in waiting:
        for car in cars:
            front_m = (car.x_m - own.x_m) * direction_of(car) + car.length_m / 2.0
            if ahead.get(car.name) and front_m >= 0.0:
                passed_s.append(own.time_s)
            ahead[car.name] = front_m < 0.0
    return tuple(round(later - earlier, 6) for earlier, later in itertools.pairwise(passed_s))


def _in_frame_of(car: State, own: State) -> tuple[float, float]:
    """Return a person's place relative to a car: ahead of its middle, and to its left."""
    dx, dy = own.x_m - car.x_m, own.y_m - car.y_m
    ahead, left = cos(car.heading_rad), sin(car.heading_rad)
    return dx * ahead + dy * left, dy * ahead - dx * left


def _free_m(own: State, car: State) -> float:
    """Return the distance between a disc and a rectangle; 0 or less if they overlap."""
    along_m, across_m = _in_frame_of(car, own)
    beyond_m = max(0.0, abs(along_m) - car.length_m / 2.0)
    beside_m = max(0.0, abs(across_m) - car.width_m / 2.0)
    return hypot(beyond_m, beside_m) - own.width_m / 2.0


def _time_to_collision_s(own: State, car: State) -> float:
    """Return when the outlines meet if both keep speed and heading; infinity if they do not.

    The car's rectangle is widened by the person's radius on all sides, so at its corners the time
    is a little too short.
    """
    place = _in_frame_of(car, own)
    turned = own.heading_rad - car.heading_rad
    speed = (own.speed_m_s * cos(turned) - car.speed_m_s, own.speed_m_s * sin(turned))
    half = ((car.length_m + own.width_m) / 2.0, (car.width_m + own.width_m) / 2.0)
    enters, leaves = 0.0, inf
    for at, rate, reach in zip(place, speed, half, strict=True):
        if abs(rate) < 1e-9:
            if abs(at) >= reach:
                return inf
            continue
        times = sorted(((-reach - at) / rate, (reach - at) / rate))
        enters, leaves = max(enters, times[0]), min(leaves, times[1])
    return enters if enters <= leaves else inf


def _post_encroachments_s(
    frames: list[tuple[State, list[State]]], crossed: list[tuple[State, list[State]]]
) -> Iterator[float]:
    """Yield, for each car, the time between one using the common area and the other.

    The area is as wide as the car's strip of the road and as long as the person's strip across it.
    """
    by_car: dict[str, list[tuple[State, State]]] = {}
    for own, cars in frames:
        for car in cars:
            by_car.setdefault(car.name, []).append((own, car))
    for _, times in sorted(by_car.items()):
        y_m = times[0][1].y_m
        half_m = (times[0][1].width_m + crossed[0][0].width_m) / 2.0
        inside = [own for own, _ in crossed if abs(own.y_m - y_m) < half_m]
        if not inside:
            continue
        x_m, radius_m = inside[0].x_m, inside[0].width_m / 2.0
        passes = [
            own.time_s for own, car in times if abs(car.x_m - x_m) < car.length_m / 2.0 + radius_m
        ]
        if not passes:
            continue
        person, car_s = (inside[0].time_s, inside[-1].time_s), (passes[0], passes[-1])
        yield max(car_s[0] - person[1], person[0] - car_s[1], 0.0)


def _finite(value: float) -> float | None:
    return value if value < inf else None

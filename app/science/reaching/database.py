"""The reaches that a model was fitted on, as tables: maps and dependencies, no paths of hands.

The tables are those of `app.science.walking.maps`, whose blending, reading and sampling are used
unchanged: a map does not know what moved. The maps here are of single reaches, with tempos of the
simulation's assumed time.
"""

from collections.abc import Sequence

import numpy as np

from app.science.reaching.agent import REACH_GRID, map_of
from app.science.reaching.records import DIFFICULTY, DISTANCE, Reach, ReachingError
from app.science.reaching.segmentation import NoReach, ReachRules
from app.science.rotations import FloatArray
from app.science.simulation import difficulty_bits, usual_time_s
from app.science.walking.maps import MAP_FLOATS, DeviationMap, WalkDatabase

LEAST_REACHES = 5
"""Fewest reaches from which anything is learnt."""


def reach_database(
    reaches: Sequence[Reach], rules: ReachRules
) -> tuple[WalkDatabase, list[NoReach]]:
    """Make the maps of reaches.

    The database depends on distance, and on the index of difficulty if every target's width is
    known. Reaches that no agent of the grid takes as long for are left out, with their reason.

    Raises:
        ReachingError: fewer than `LEAST_REACHES` are left.
    """
    kept: list[Reach] = []
    maps: list[DeviationMap] = []
    left_out: list[NoReach] = []
    for reach in reaches:
        found = map_of(reach, rules.still_m_s)
        tempo = reach.duration_s / usual_time_s(reach.distance_m, reach.near_m)
        if np.isnan(best_log_tempo(found)):
            reason = f"it takes {tempo:.2g} times the assumed time, beyond the agent's tempos"
            left_out.append(NoReach(f"{reach.who.source}, {reach.hand}", 0.0, reason))
        else:
            kept.append(reach)
            maps.append(found)
    if len(kept) < LEAST_REACHES:
        raise ReachingError(
            f"There are {len(kept)} reaches; at least {LEAST_REACHES} are needed. A reach is from"
            f" rest to rest, {rules.shortest_m:g} to {rules.longest_m:g} m, and takes at most"
            f" {rules.longest_s:g} s: give more recordings, or check their units."
        )
    by_width = all(reach.who.width_m is not None for reach in kept)
    names = (DISTANCE, DIFFICULTY) if by_width else (DISTANCE,)
    vectors = [dependencies_of(reach.distance_m, reach.near_m, names) for reach in kept]
    database = WalkDatabase(
        grid=REACH_GRID,
        metric="mean distance",
        names=names,
        vectors=np.stack(vectors),
        deviations=np.stack([one.deviations.ravel() for one in maps]).astype(MAP_FLOATS),
        arrivals_s=np.stack([one.arrival_s.ravel() for one in maps]).astype(MAP_FLOATS),
        durations_s=np.array([reach.duration_s for reach in kept]),
        lengths_m=np.array([reach.distance_m for reach in kept]),
        subjects=tuple(reach.who.subject for reach in kept),
        sources=tuple(reach.who.source for reach in kept),
        kinds=tuple(reach.who.kind for reach in kept),
    )
    return database, left_out


def dependencies_of(distance_m: float, near_m: float, names: Sequence[str]) -> FloatArray:
    """Return the dependencies (m,) of a reach of a distance to a target of a half width."""
    known = {DISTANCE: distance_m, DIFFICULTY: difficulty_bits(distance_m, near_m)}
    return np.array([known[name] for name in names])


def best_log_tempo(found: DeviationMap) -> float:
    """Return the logarithm of the tempo that takes as long as the reach, with the best skew.

    For each skew the tempo is interpolated that arrives when the hand did; of these the one that
    deviates least is taken. NaN if there is none.
    """
    log_tempos = np.array(found.grid.values[0])
    best = (np.inf, np.nan)
    for at in range(found.grid.shape[1]):
        arrival_s, deviation = found.arrival_s[:, at], found.deviations[:, at]
        arrived = np.isfinite(arrival_s)
        own_s, own_log = arrival_s[arrived], log_tempos[arrived]
        # A slow agent is hardly faster than the threshold, and cut short: only the rise counts.
        rising = int(np.argmax(own_s)) + 1 if len(own_s) else 0
        own_s, own_log = own_s[:rising], own_log[:rising]
        if rising < 2 or not own_s[0] <= found.reference_s <= own_s[-1]:
            continue
        log_tempo = float(np.interp(found.reference_s, own_s, own_log))
        deviates = float(np.interp(log_tempo, log_tempos, deviation))
        best = min(best, (deviates, log_tempo))
    return best[1]


def log_tempos_of(database: WalkDatabase) -> FloatArray:
    """Return the logarithm of each reach's tempo, (N,)."""
    return np.array([best_log_tempo(database.map_at(at)) for at in range(len(database))])

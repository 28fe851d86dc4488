"""Summarise a set of walks and a fitted model; runs in the worker process."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from app.science.walking.evaluation import (
    LeftOut,
    neighbours_left_out,
    nodes_left_out,
    people_left_out,
    times_left_out,
)
from app.science.walking.models import FittedWalking
from app.science.walking.recording import census
from app.science.walking.records import LENGTH, STATURE, TURNING, PlannedWalk, Walk

Json = dict[str, Any]
PAPERS = {LENGTH, TURNING, STATURE}


def walks_summary(entries: Sequence[PlannedWalk]) -> Json:
    """Return a `WalksSummary` of walks."""
    walks = [entry.walk for entry in entries]
    names = sorted({name for entry in entries for name in entry.dependencies} & PAPERS)
    everywhere = [name for name in names if all(name in entry.dependencies for entry in entries)]
    ranges = {name: _range([entry.dependencies[name] for entry in entries]) for name in everywhere}
    return {
        "walks": len(walks),
        "people": len({walk.subject for walk in walks}),
        "cut_by_recording": sum(not (walk.begins_still and walk.ends_still) for walk in walks),
        "duration_s": _range([walk.duration_s for walk in walks]),
        "speed_m_s": _range([walk.length_m / walk.duration_s for walk in walks]),
        "dependencies": ranges,
        "missing_dependencies": [name for name in names if name not in everywhere],
        "census": asdict(census([entry.path.length_m for entry in entries])),
        "scenes": scene_counts(entries),
        "numbers": _numbers(walks),
        "changing_numbers": sorted(
            {name for walk in walks for name in walk.changing}
            - {name for walk in walks for name in walk.others}
        ),
    }


def scene_counts(entries: Sequence[PlannedWalk]) -> list[Json]:
    """Return a `WalksInScene` for each scene that walks name, and for those that name none."""
    counts = Counter(entry.walk.scene for entry in entries)
    return [{"key": key, "walks": count} for key, count in counts.most_common()]


def _numbers(walks: Sequence[Walk]) -> Json:
    """Return, for each further number, the walks that have it, and its range over them."""
    names = dict.fromkeys(name for walk in walks for name in walk.others)
    found: Json = {}
    for name in names:
        known = [walk for walk in walks if name in walk.others]
        found[name] = {
            "walks": len(known),
            "people": len({walk.subject for walk in known}),
            "range": _range([walk.others[name] for walk in known]),
        }
    return found


def model_summary(fit: FittedWalking, digest: str) -> Json:
    """Return a `ModelSummary` of a fitted model."""
    base, static = fit.database, fit.static
    seeds = np.random.default_rng(fit.options.seed).spawn(3)
    people = people_left_out(
        base, fit.reading, seeds[0], entries=fit.options.entries, k=fit.options.k
    )
    return {
        "model_hash": digest,
        "walks": len(base),
        "people": len(base.persons),
        "duration_s": _range(base.durations_s),
        "dependencies": {name: _range(base.vectors[:, at]) for at, name in enumerate(base.names)},
        "parameters": [
            {**asdict(one), "values": list(values)}
            for one, values in zip(base.grid.parameters, base.grid.values, strict=True)
        ],
        "reading": asdict(fit.reading),
        "readings": [{"reading": asdict(one.options), "crps_s": one.crps_s} for one in fit.scores],
        "entries": len(fit.space.z),
        "k": fit.space.k,
        "static_vector": static.vector.tolist(),
        "left_out": {
            "neighbours": _left_out(neighbours_left_out(fit.space)),
            "nodes": _left_out(nodes_left_out(fit.space, seeds[1])),
            "people": _left_out(people),
        },
        "predicted": [asdict(one) for one in times_left_out(base, seeds[2])],
        "census": asdict(census(base.lengths_m.tolist())),
    }


def _left_out(found: LeftOut) -> Mapping[str, float]:
    return {"mean_percent": found.mean, "sd_percent": found.sd, "entries": found.entries}


def _range(values: Sequence[float] | np.ndarray[Any, np.dtype[np.float64]]) -> Json:
    low, middle, high = np.quantile(np.asarray(values, dtype=np.float64), (0.0, 0.5, 1.0))
    mean = float(np.mean(values))
    return {"low": float(low), "median": float(middle), "high": float(high), "mean": mean}

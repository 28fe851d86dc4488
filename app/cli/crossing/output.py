"""Format the results of `reembody crossing`: JSON for scripts, sentences for people."""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from app.cli.crossing.run import Done, ListedScene
from app.science.cosimulation import Crossing, Guess


def run_json(done: Done) -> dict[str, object]:
    """Return the whole result of a run, without the record's states."""
    record = done.record
    return {
        "scene": done.scene.file.key,
        "scene_sha256": done.scene.sha256,
        "seed": done.seed,
        "steps": len(record.steps) - 1,
        "step_s": record.step_s,
        "ended": "partner lost" if record.lost else "complete",
        "reason": record.lost,
        "crossings": [asdict(one) for one in done.crossings],
        "guesses": {"count": len(record.guesses), "largest_error_m": _largest(record.guesses)},
        "record_sha256": record.sha256,
        "record": None if done.out is None else str(done.out),
        "step_ms": _step_ms(done),
        "waited_s": {name: round(value, 6) for name, value in done.timing.waited_s.items()},
    }


def run_text(done: Done) -> str:
    """Return a run's result as lines."""
    record, step_ms = done.record, _step_ms(done)
    scene_s = (len(record.steps) - 1) * record.step_s
    lines = [
        f"{done.scene.file.key}, seed {done.seed}: {scene_s:g} s in steps of {record.step_s:g} s"
    ]
    for one in done.crossings:
        lines += _crossing_text(one)
    lines.append(_guesses_text(record.guesses))
    if step_ms["p50"] is not None:
        took = f"a step took {step_ms['p50']:.2f} ms (median), {step_ms['p99']:.2f} ms (p99)"
        waited = max(done.timing.waited_s.items(), key=lambda item: item[1])
        lines.append(f"{took}; longest waited for: {waited[0]}, {waited[1]:.2f} s in all")
    where = "" if done.out is None else f"{done.out}, "
    lines.append(f"record: {where}sha256 {record.sha256}")
    return "\n".join(lines)


def scenes_json(listed: Sequence[ListedScene]) -> list[dict[str, str]]:
    """Return the included scenes."""
    return [asdict(one) for one in listed]


def scenes_text(listed: Sequence[ListedScene]) -> str:
    """Return the included scenes as lines."""
    return "\n".join(
        f"{one.key}: {one.title}" + (f"\n  {one.missing}" if one.missing else "") for one in listed
    )


def _crossing_text(one: Crossing) -> list[str]:
    if one.steps_on_s is None:
        return [f"{one.person}: did not step onto the carriageway; stood {one.waited_s:g} s at it"]
    gap = "no car was coming" if one.gap_accepted_s is None else f"{one.gap_accepted_s:.2f} s"
    refused = ", ".join(f"{gap_s:.2f}" for gap_s in one.gaps_refused_s) or "none"
    over = "not across" if one.steps_off_s is None else f"across at {one.steps_off_s:g} s"
    lines = [
        f"{one.person}: on the carriageway at {one.steps_on_s:g} s, {over}",
        f"  waited {one.waited_s:.2f} s; gap accepted: {gap}; gaps refused, s: {refused}",
        (
            f"  least time to collision: {_seconds(one.least_time_to_collision_s)};"
            f" least post-encroachment time: {_seconds(one.least_post_encroachment_s)};"
            f" closest to a car: {'-' if one.closest_m is None else f'{one.closest_m:.2f} m'}"
        ),
    ]
    if one.collision is not None:
        hit = one.collision
        speed = f"{hit.car_speed_m_s:.2f} m/s"
        lines.append(f"  COLLISION with {hit.car} at {hit.time_s:g} s, which drove {speed}")
    return lines


def _guesses_text(guesses: Sequence[Guess]) -> str:
    if not guesses:
        return "nothing was extrapolated"
    largest = _largest(guesses)
    known = "" if largest is None else f", at most {largest:.3f} m from what came later"
    return f"{len(guesses)} states were extrapolated{known}"


def _largest(guesses: Sequence[Guess]) -> float | None:
    return max((one.error_m for one in guesses if one.error_m is not None), default=None)


def _step_ms(done: Done) -> dict[str, float | None]:
    """Return percentiles of the real time of a step, in milliseconds."""
    steps_s = done.timing.steps_s
    if not steps_s:
        return {"p50": None, "p99": None}
    p50, p99 = np.percentile(np.array(steps_s) * 1000.0, [50, 99])
    return {"p50": round(float(p50), 4), "p99": round(float(p99), 4)}


def _seconds(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f} s"

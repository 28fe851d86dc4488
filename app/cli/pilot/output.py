"""Print a pilot: how far it is, the curve, and what it rests on."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from app.features.results.pilot.simulation import Curve, Progress, Tell
from app.science.pilot import PowerPoint, smallest_sufficient

_COLUMNS = (
    "     n  in test   power    95 % band       level    95 % band       type S  type M  failed"
)


def told(study: str, now: Callable[[str], None]) -> Tell:
    """Return what tells a person in words how far the pilot of a study is."""

    def tell(at: Progress) -> None:
        match at.stage:
            case "check":
                now(f"checking {study}: {at.done} of {at.total} bodies")
            case "people":
                now(f"simulating {study}: {at.done} of {at.total} people")
            case "power":
                now(f"simulating {study}: {at.done} of {at.total} parts")

    return tell


def missing_line(count: int, what: str, shards: Sequence[str]) -> str:
    """Say what is not simulated yet, and which shards to run and merge."""
    how = f"run --shard {' and '.join(shards)}" if shards else "run the other shards"
    return f"UNFINISHED, missing: {count} {what}. To finish, {how}, and merge all parts."


def curve_text(curve: Curve) -> str:
    """Describe a curve, with its assumptions below it."""
    return "\n".join(_lines(curve))


def _lines(curve: Curve) -> Iterator[str]:
    header, test = curve.header, curve.header["test"]
    measure = test["score"] or test["measure"]
    kind = "preregistered test" if header["preregistered"] else "test that might be declared"
    state = "SIMULATED, UNFINISHED" if curve.unfinished else "SIMULATED"
    yield f"{state}: the power of the {kind} of {header['study']}, if people are as assumed"
    way, alpha = test["direction"], header["alpha"]
    yield f"{test['test']} of {measure} ({test['limb']}), {way}, alpha {alpha:g}"
    yield f"{header['sets']} data sets with the effect and as many without, seed {header['seed']}"
    yield ""
    yield _COLUMNS
    yield from map(_row, curve.points)
    if curve.unfinished:
        yield missing_line(curve.unfinished, "parts", curve.missing)
    yield ""
    target = header["target"]
    smallest = smallest_sufficient(curve.points, target)
    planned = f"{header['planned_n']} are planned"
    hopeless = [point.n for point in curve.points if point.never_tested]
    if hopeless:
        numbers = ", ".join(map(str, hopeless))
        yield (
            f"With n of {numbers} no data set could be analysed, so there is no power and no level:"
            " too few participants reach the test. Look at the dropout that is assumed."
        )
    if any(point.failures + point.level_failures for point in curve.points):
        yield (
            f"failed: data sets on which the test could not be computed, of {header['sets']} with"
            f" and {header['sets']} without the effect; they count as not significant."
        )
    if hopeless and len(hopeless) == len(curve.points):
        yield f"No number can be recommended; {planned}."
    elif smallest is None:
        yield f"With none of these numbers does the lower bound reach {target:g}; {planned}."
    else:
        yield f"{smallest} is the smallest n whose lower bound reaches {target:g}; {planned}."
    if lost := _lost(curve):
        yield lost
    difference = header["assumed_difference"]
    yield f"Assumed difference, longest against shortest latency: {difference:.3g} of {measure}."
    yield ""
    yield from assumption_lines(header["assumptions"])


def assumption_lines(assumptions: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Yield what is assumed, each number with its unit and its source."""
    yield "Assumptions, none of them a finding:"
    for one in assumptions:
        value = one["value"]
        shown = ", ".join(f"{x:g}" for x in value) if isinstance(value, list) else f"{value:g}"
        yield f"  {one['name']}: {shown} {one['unit']} ({one['source']})"


def _lost(curve: Curve) -> str | None:
    """Say who of those who start is not in the test, and which assumptions say so."""
    started = sum(point.n for point in curve.points)
    left = sum(point.mean_in_test for point in curve.points)
    if not started or left >= started:
        return None
    words = {
        "dropout": "stop, {} in each block",
        "excluded": "are excluded for a technical reason, {}",
        "answering.straight_lining": "hand in more straight-lined forms, {} of all forms, than a"
        " declared exclusion allows",
    }
    stated = {one["name"]: one["value"] for one in curve.header["assumptions"]}
    if all(one["rule"] != "maximum_straight_lined_forms" for one in curve.header["exclusions"]):
        stated.pop("answering.straight_lining", None)
    reasons = [text.format(f"{stated[name]:g}") for name, text in words.items() if stated.get(name)]
    return (
        f"{100.0 * (1.0 - left / started):.0f} % of those who start are not in the test. As"
        f" assumed, they {'; or '.join(reasons)}."
    )


def _row(point: PowerPoint) -> str:
    if point.never_tested:
        return (
            f"{point.n:6d} {point.mean_in_test:8.1f}   {'-':>5}   {'-':^14}   {'-':>5}   "
            f"{'-':^14}   {_or_dash(None)}  {_or_dash(None)}"
            f"  {point.failures + point.level_failures:6d}"
        )
    return (
        f"{point.n:6d} {point.mean_in_test:8.1f}   {point.power:5.3f}   "
        f"{point.low:.3f} to {point.high:.3f}   {point.level:5.3f}   "
        f"{point.level_low:.3f} to {point.level_high:.3f}   {_or_dash(point.type_s)}  "
        f"{_or_dash(point.type_m)}  {point.failures + point.level_failures:6d}"
    )


def _or_dash(value: float | None) -> str:
    return f"{'-':>6}" if value is None else f"{value:6.3f}"

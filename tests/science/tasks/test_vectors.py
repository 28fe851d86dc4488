"""Tests of the task rules' vectors, which the headset must reproduce too."""

from dataclasses import asdict

import numpy as np
import pytest

from app.science.tasks import (
    Command,
    CommandKind,
    Laterality,
    SurfaceArrays,
    SurfaceKind,
    TaskRuleError,
    TaskRules,
    TaskRun,
    current_goal,
    displayed_numbers,
    rederive,
    segment_box_distance_m,
    side_unit,
    surface_state,
    touching_and_near,
    touching_frames,
)
from app.science.tasks.state import TaskState
from tests.science.tasks.vector_files import Json, build, layout, of_kind, read_all, step

RULES = [pytest.param(vector, id=name) for name, vector in of_kind("rules")]
WITH_INTERVALS = [
    pytest.param(vector, id=name)
    for name, vector in of_kind("rules")
    if "intervals" in vector["expected"]
]
FRAMES = [pytest.param(vector, id=name) for name, vector in of_kind("frames")]


def play(vector: Json) -> tuple[TaskRun, list[TaskState]]:
    """Return the run of a rules vector, and its state after each input."""
    rules = TaskRules(layout(vector["layout"]), Laterality(vector["writing_hand"]))
    run, states = TaskRun(rules, ()), []
    for entry in vector["inputs"]:
        if entry.get("refused"):
            with pytest.raises(TaskRuleError):
                run.apply(step(entry))
        else:
            run.apply(step(entry))
        states.append(run.state)
    return run, states


@pytest.mark.parametrize("vector", RULES)
def test_events_are_those_of_the_vector(vector: Json) -> None:
    """Every rules vector gives its events in order, with both times."""
    run, _ = play(vector)
    assert vector["expected"]["events"] == [asdict(event) for event in run.events]


@pytest.mark.parametrize("vector", RULES)
def test_summaries_are_those_of_the_vector(vector: Json) -> None:
    """Every rules vector gives its completions and its contact times of sides and parts."""
    run, _ = play(vector)
    summary, expected = run.summary(), vector["expected"]
    found = [{**asdict(done), "order": list(done.order)} for done in summary.completions]
    parts = {(side, part): time_s for side, part, time_s in expected["part_side_time_s"]}
    assert expected["completions"] == found
    assert expected["side_red_time_s"] == summary.side_red_time_s
    assert parts == summary.part_side_time_s


@pytest.mark.parametrize("vector", WITH_INTERVALS)
def test_intervals_are_those_of_the_vector(vector: Json) -> None:
    """The recorded contact intervals are exactly those of the vector, where it lists them."""
    run, _ = play(vector)
    expected = [tuple(interval.values()) for interval in vector["expected"]["intervals"]]
    found = [tuple(asdict(interval).values()) for interval in run.intervals]
    assert sorted(expected) == sorted(found)


@pytest.mark.parametrize("vector", RULES)
def test_views_are_those_of_the_vector(vector: Json) -> None:
    """Goal, numbers and colours are those of the vector at its times."""
    _, states = play(vector)
    for view in vector["expected"]["views"]:
        past = [entry["time_s"] <= view["time_s"] for entry in vector["inputs"]]
        state = states[past.count(True) - 1]
        colours = surface_state(state)
        numbers = {str(box): number for box, number in displayed_numbers(state).items()}
        green = {k for k, c in colours.items() if c == "green" and not k.endswith("/target")}
        red = {key for key, c in colours.items() if c == "red"}
        assert (view["goal"], view["numbers"]) == (current_goal(state), numbers)
        assert (set(view["green"]), set(view["red"])) == (green, red)


@pytest.mark.parametrize("vector", RULES)
def test_completions_can_be_derived_from_the_record(vector: Json) -> None:
    """The completions of every vector follow from its intervals and commands alone."""
    run, _ = play(vector)
    inputs = [step(entry) for entry in vector["inputs"] if not entry.get("refused")]
    commands = [given for given in inputs if isinstance(given, Command)]
    found = rederive(run.state.rules, run.intervals, commands)
    assert run.summary().completions == found


def test_layouts_are_those_of_the_vector() -> None:
    """Every layout of the vectors gives its surfaces in order."""
    for spec in read_all()["layouts"]["layouts"].values():
        surfaces = build(spec).surfaces
        assert [s["key"] for s in spec["surfaces"]] == [s.key for s in surfaces]
        for expected, surface in zip(spec["surfaces"], surfaces, strict=True):
            assert (expected["kind"], expected["box"]) == (surface.kind, surface.box)
            assert expected["side"] == surface.side
            assert (surface.kind is SurfaceKind.SIDE) == (side_unit(surface.key) is not None)
            np.testing.assert_allclose(surface.center_m, expected["center_m"], atol=1e-9)
            np.testing.assert_allclose(surface.half_size_m, expected["half_size_m"], atol=1e-9)


def test_distances_are_those_of_the_vector() -> None:
    """Distances between segments and blocks are those of the vector."""
    cases = read_all()["distances"]["cases"]
    names = ("start_m", "end_m", "low_m", "high_m")
    found = segment_box_distance_m(*(np.array([case[n] for case in cases]) for n in names))
    np.testing.assert_allclose(found, [case["distance_m"] for case in cases], atol=1e-12)


def test_touches_are_those_of_the_vector() -> None:
    """Capsules touch, and are near, exactly the surfaces of the vector."""
    vector = read_all()["touches"]
    arrays = SurfaceArrays.of(layout(vector["layout"]))
    for case in vector["cases"]:
        segments = np.array([[part["start_m"], part["end_m"]] for part in case["parts"]])
        radii = np.array([part["radius_m"] for part in case["parts"]])
        found = touching_and_near(arrays, segments, radii, vector["release_margin_m"])
        for name, table in zip(("touching", "near"), found, strict=True):
            pairs = {(arrays.keys[s], case["parts"][p]["part"]) for s, p in np.argwhere(table)}
            assert {tuple(pair) for pair in case[name]} == pairs, case["note"]


@pytest.mark.parametrize("vector", FRAMES)
def test_frames_give_the_intervals_of_the_vector(vector: Json) -> None:
    """Frames of capsules give the contact intervals of the vector."""
    place = layout(vector["layout"])
    arrays, radii = SurfaceArrays.of(place), np.array(vector["radii_m"])
    run = TaskRun(TaskRules(place, Laterality(vector["writing_hand"])), tuple(vector["parts"]))
    run.command(CommandKind.START, vector["start_s"])
    segments = np.array([frame["segments_m"] for frame in vector["frames"]])
    touches, near = touching_frames(arrays, segments, radii, vector["release_margin_m"])
    for index, frame in enumerate(vector["frames"]):
        run.frame(frame["time_s"], touches[index], near[index])
    run.command(CommandKind.FREEZE, vector["freeze_s"])
    assert vector["expected"]["intervals"] == [asdict(interval) for interval in run.intervals]

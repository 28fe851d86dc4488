"""Tests of drawing figures from tables, without a database."""

from typing import Any

import pandas as pd
import pytest

from app.features.results.analysis.figures import (
    completions_drawing,
    contact_map_drawing,
    contacts_drawing,
    crossings_drawings,
    embodiment_drawings,
    joint_error_drawing,
    joint_error_map_drawing,
    progress_drawing,
)
from app.features.results.analysis.figures.by_latency import mean_interval
from app.features.results.analysis.figures.drawing import Drawing, limb_note
from app.features.results.analysis.figures.fingers import joint_error_fingers_drawings, mark_fingers
from app.features.results.analysis.figures.joint_errors import BODY_PARTS, JOINTS_BY_PART
from app.science.joint_error import ERROR_JOINTS
from app.science.skeleton import FINGER_PARTS


def _phases(completions: dict[str, dict[float, int]], limb: str = "hand") -> pd.DataFrame:
    return pd.DataFrame(
        [
            {
                "participant_code": code,
                "session_id": code,
                "phase_id": int(latency),
                "phase_kind": "task",
                "limb": limb,
                "position": 1,
                "latency_ms": latency,
                "completions": count,
                "fingers": False,
            }
            for code, by_latency in completions.items()
            for latency, count in by_latency.items()
        ]
    )


def _contact(code: str, latency: float, part: str, begin_s: float, end_s: float) -> dict[str, Any]:
    return {
        "session_id": code,
        "phase_id": int(latency),
        "surface": "hand/2/left",
        "surface_kind": "side",
        "body_part": part,
        "begin_active_s": begin_s,
        "end_active_s": end_s,
    }


def _errors(angle_deg: float, code: str, latency: float, **changes: object) -> list[dict[str, Any]]:
    row = {
        "participant_code": code,
        "phase_kind": "task",
        "reference": "present",
        "axis": "angle",
        "latency_ms": latency,
        "mean_deg": angle_deg,
        "clipped_share": None,
    }
    return [{**row, "joint": joint, **changes} for joint in ERROR_JOINTS]


def _traces(drawing: Drawing, name: str) -> list[dict[str, Any]]:
    figure = drawing.as_json()
    assert figure is not None, drawing.empty
    return [trace for trace in figure["data"] if trace.get("name") == name]


def test_the_interval_uses_students_t() -> None:
    """The interval of 1 to 5 uses Student's t: mean 3, s = sqrt(2.5), t = 2.7764, so ± 1.9633."""
    interval = mean_interval([1.0, 2.0, 3.0, 4.0, 5.0])
    assert (interval.mean, interval.n) == (3.0, 5)
    assert interval.half_width == pytest.approx(1.9633, abs=1e-4)


def test_one_value_has_a_mean_and_no_interval() -> None:
    """One value has a mean but no interval; no values are an error."""
    assert mean_interval([2.0]).half_width is None
    with pytest.raises(ValueError, match="at least one"):
        mean_interval([])


def test_means_are_over_participants() -> None:
    """Means are over participants: one with many phases has the same weight as one with few."""
    twice = _phases({"P-1": {0.0: 4}, "P-2": {0.0: 1}})
    frame = pd.concat([twice, _phases({"P-1": {0.0: 4}})])
    (mean,) = _traces(completions_drawing(frame), "mean, hand")
    assert mean["y"] == [2.5]


def test_every_participant_has_a_line() -> None:
    """Every participant has a line, separated by gaps and named in the hover text."""
    drawing = completions_drawing(_phases({"P-1": {0.0: 5, 125.0: 3}, "P-2": {0.0: 4, 125.0: 1}}))
    (people,) = _traces(drawing, "participants")
    assert people["text"] == ["P-1", "P-1", None, "P-2", "P-2", None]
    assert people["y"] == [5.0, 3.0, None, 4.0, 1.0, None]


def test_limbs_differ_in_panel_symbol_and_dash() -> None:
    """Hand and foot differ in panel, symbol and dash, not only in colour."""
    counts = {"P-1": {0.0: 5}, "P-2": {0.0: 4}}
    drawing = completions_drawing(pd.concat([_phases(counts), _phases(counts, limb="foot")]))
    (hand,), (foot,) = _traces(drawing, "mean, hand"), _traces(drawing, "mean, foot")
    assert hand.get("xaxis") != foot.get("xaxis")
    assert hand["marker"]["symbol"] != foot["marker"]["symbol"]
    assert hand["line"]["dash"] != foot["line"]["dash"]


def test_scores_that_are_missing_do_not_count() -> None:
    """A participant without a score is left out of the figure of that score."""
    scores = pd.DataFrame(
        {
            "participant_code": ["P-1", "P-2", "P-3"],
            "instrument": "karas2020",
            "score": "agency",
            "limb": "hand",
            "position": 1,
            "latency_ms": 0.0,
            "value": [4.0, 6.0, None],
            "minimum": -12.0,
            "maximum": 12.0,
        }
    )
    by_key = {drawing.key: drawing for drawing in embodiment_drawings(scores)}
    (mean,) = _traces(by_key["embodiment_agency"], "mean, hand")
    assert (mean["y"], by_key["embodiment_agency"].n) == ([5.0], 2)
    assert by_key["embodiment_ownership"].empty is not None


def _scores(values: dict[str, dict[float, float]]) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {
                "participant_code": code,
                "limb": "hand",
                "position": 1,
                "latency_ms": latency,
                "score": "agency",
                "value": value,
                "minimum": -15.0,
                "maximum": 15.0,
                "instrument": "karas2020",
            }
            for code, by_latency in values.items()
            for latency, value in by_latency.items()
        ]
    )


def _agency(values: dict[str, dict[float, float]]) -> Drawing:
    return next(one for one in embodiment_drawings(_scores(values)) if one.key.endswith("agency"))


def test_the_number_of_participants_is_beside_the_panels_title_and_never_below_an_axis() -> None:
    """Where latencies differ in n, its range is named; ticks are the latencies alone."""
    figure = _agency({"P-1": {0.0: 7.0, 350.0: 2.0}, "P-2": {0.0: 5.0}}).as_json()
    assert figure is not None
    assert figure["layout"]["annotations"][0]["text"] == "Hand task, n = 1–2"
    assert figure["layout"]["xaxis"]["ticktext"] == ["0", "350"]
    alike = _agency({"P-1": {0.0: 7.0}, "P-2": {0.0: 5.0}}).as_json()
    assert alike is not None
    assert alike["layout"]["annotations"][0]["text"] == "Hand task, n = 2"


def test_an_interval_beyond_the_possible_values_is_marked_where_it_leaves_the_axis() -> None:
    """Of 15 and 13 the interval is 14 ± 12.7, so it goes on above 16.5; of 1 and 2 it does not."""
    drawing = _agency({"P-1": {0.0: 15.0, 350.0: 1.0}, "P-2": {0.0: 13.0, 350.0: 2.0}})
    (mark,) = _traces(drawing, "interval goes on, hand")
    assert (mark["x"], mark["y"]) == ([0.0], [16.5])
    assert mark["marker"]["symbol"] == "triangle-up"
    assert mark["customdata"] == pytest.approx([14.0 + 12.7062])
    assert not mark["cliponaxis"]


def test_every_joint_is_in_one_part_of_the_body() -> None:
    """Each of the 21 joints is in exactly one of six body parts."""
    assert len(BODY_PARTS) == 6
    assert sorted(JOINTS_BY_PART) == sorted(ERROR_JOINTS)


def test_joint_error_figures_use_the_angle_to_the_present_pose() -> None:
    """Joint error figures use the whole angle to the present target pose, in tasks only."""
    rows = [
        *_errors(10.0, "P-1", 125.0),
        *_errors(20.0, "P-2", 125.0),
        *_errors(99.0, "P-1", 125.0, axis="x"),
        *_errors(99.0, "P-1", 125.0, reference="command"),
        *_errors(99.0, "P-1", 0.0, phase_kind="free_roam"),
    ]
    drawing = joint_error_drawing(pd.DataFrame(rows))
    for part in BODY_PARTS:
        (trace,) = _traces(drawing, part)
        assert trace["y"] == [15.0]
        assert trace["customdata"][0][0] == 125.0
    figure = joint_error_map_drawing(pd.DataFrame(rows)).as_json()
    assert figure is not None
    (heat,) = figure["data"]
    assert (heat["x"], heat["y"]) == (list(JOINTS_BY_PART), ["125"])
    assert heat["z"] == [[15.0] * 21]
    assert heat["customdata"] == [[""] * 21]


def test_the_joint_error_map_states_clipped_shares() -> None:
    """The joint error map of a physics avatar states how often each joint was clipped."""
    rows = [
        {**row, "clipped_share": share if row["joint"] == "Head" else 0.0}
        for code, share in (("P-1", 0.1), ("P-2", 0.32))
        for row in _errors(10.0, code, 125.0)
        if "Shoulder" not in row["joint"]
    ]
    drawing = joint_error_map_drawing(pd.DataFrame(rows))
    figure = drawing.as_json()
    assert figure is not None
    (heat,) = figure["data"]
    reported = dict(zip(heat["x"], heat["customdata"][0], strict=True))
    assert reported["Head"] == "<br>clipped in 21.0 % of samples"
    assert reported["Neck"] == "<br>clipped in 0.0 % of samples"
    assert "in 1.1 % of the samples, Head most often (21.0 %)" in drawing.caption
    assert "before their limits" in joint_error_drawing(pd.DataFrame(rows)).caption
    plain = joint_error_map_drawing(pd.DataFrame(_errors(10.0, "P-1", 125.0)))
    assert "limit" not in plain.caption


def test_contact_time_of_a_side_is_the_union_over_parts() -> None:
    """The contact time of a side is the union over body parts, which are shown separately."""
    phases = _phases({"P-1": {0.0: 1}, "P-2": {0.0: 1}})
    contacts = [
        _contact(code, 0.0, part, begin_s, begin_s + 2.0)
        for code in ("P-1", "P-2")
        for part, begin_s in (("LeftHand", 1.0), ("LeftLowerArm", 2.0))
    ]
    sides, parts = _traces(contacts_drawing(phases, pd.DataFrame(contacts)), "0 ms")
    assert dict(zip(sides["x"], sides["y"], strict=True)) == {"left": 3.0}
    assert dict(zip(parts["x"], parts["y"], strict=True)) == {"LeftHand": 2.0, "LeftLowerArm": 2.0}


def test_the_contact_time_of_a_finger_is_the_union_over_its_parts() -> None:
    """The three parts of a finger are one finger, whose overlapping contacts count once."""
    phases = _phases({"P-1": {0.0: 1}, "P-2": {0.0: 1}})
    contacts = [
        _contact(code, 0.0, part, begin_s, begin_s + 2.0)
        for code in ("P-1", "P-2")
        for part, begin_s in (
            ("RightThumbProximal", 1.0),
            ("RightThumbDistal", 2.0),
            ("RightHand", 1.0),
        )
    ]
    phases = phases.assign(fingers=True)
    _, parts = _traces(contacts_drawing(phases, pd.DataFrame(contacts)), "0 ms")
    assert dict(zip(parts["x"], parts["y"], strict=True)) == {"RightHand": 2.0, "RightThumb": 3.0}


def test_means_by_finger_are_over_phases_with_fingers_only() -> None:
    """A phase that sent no fingers is no zero: it enters the mean of the hand, not of fingers."""
    contacts = pd.DataFrame(
        [
            _contact("P-1", 0.0, "RightThumbDistal", 1.0, 4.0),
            _contact("P-1", 0.0, "RightHand", 1.0, 3.0),
            _contact("P-2", 0.0, "RightHand", 1.0, 2.0),
            _contact("P-3", 125.0, "RightHand", 1.0, 2.0),
        ]
    )
    phases = _phases({"P-1": {0.0: 1}, "P-2": {0.0: 1}, "P-3": {125.0: 1}})
    streams = pd.DataFrame({"session_id": ["P-4"], "phase_id": [0], "stream": ["actual_fingers"]})
    more = pd.concat((phases, _phases({"P-4": {0.0: 1}})), ignore_index=True)
    drawing = contacts_drawing(mark_fingers(more, streams, contacts), contacts)
    drawn = drawing.data[drawing.data["what"] == "body parts"]
    assert {
        (row.of, row.latency_ms): (row.mean_s_per_phase, row.n) for row in drawn.itertuples()
    } == {
        ("RightHand", 0.0): (1.0, 1),
        ("RightHand", 125.0): (1.0, 1),
        ("RightPalm", 0.0): (1.0, 2),
        ("RightThumb", 0.0): (1.5, 2),
    }
    assert "Fingers: only phases in which they were recorded, n = 2." in drawing.caption
    figure = contact_map_drawing(mark_fingers(more, streams, contacts), contacts).as_json()
    assert figure is not None
    unknown = [dict(zip(one["y"], one["z"], strict=True)) for one in figure["data"]][1]
    assert unknown == {"RightHand": [1.0], "RightPalm": [None], "RightThumb": [None]}


def test_fingers_have_a_figure_of_their_own_and_change_no_other() -> None:
    """Joint errors of fingers are drawn by finger and enter no mean over the body's joints."""
    body = pd.DataFrame([*_errors(10.0, "P-1", 125.0), *_errors(20.0, "P-2", 125.0)])
    fingers = pd.DataFrame(
        [
            {**row, "joint": part, "mean_deg": 40.0 if part.startswith("LeftThumb") else 2.0}
            for code in ("P-1", "P-2")
            for row in _errors(0.0, code, 125.0)[:1]
            for part in FINGER_PARTS
        ]
    )
    both = pd.concat((body, fingers), ignore_index=True)
    assert joint_error_map_drawing(both).as_json() == joint_error_map_drawing(body).as_json()
    assert list(joint_error_fingers_drawings(body)) == []
    (drawing,) = joint_error_fingers_drawings(both)
    figure = drawing.as_json()
    assert figure is not None
    (heat,) = figure["data"]
    assert dict(zip(heat["x"], heat["z"][0], strict=True))["LeftThumb"] == 40.0
    assert (len(heat["x"]), max(heat["z"][0][1:])) == (10, 2.0)


def test_a_phase_without_a_contact_counts_as_zero() -> None:
    """A phase without contacts counts as zero seconds in the mean."""
    phases = _phases({"P-1": {0.0: 1}, "P-2": {0.0: 1}})
    contacts = pd.DataFrame([_contact("P-1", 0.0, "LeftHand", 1.0, 4.0)])
    sides, _ = _traces(contacts_drawing(phases, contacts), "0 ms")
    assert sides["y"] == [1.5]


def test_no_contacts_at_all_give_a_sentence() -> None:
    """Without any contact, the figure is replaced by a sentence."""
    phases = _phases({"P-1": {0.0: 1}, "P-2": {0.0: 1}})
    none = pd.DataFrame([_contact("P-1", 0.0, "LeftHand", 1.0, 4.0)]).iloc[:0]
    drawing = contacts_drawing(phases, none)
    assert drawing.figure is None
    assert drawing.empty == "No side of a box was touched in any valid phase."


def test_progress_shows_every_order() -> None:
    """Progress shows the sessions of every order by status, including orders without sessions."""
    sessions = pd.DataFrame(
        {
            "participant_code": ["P-1", "P-2", "P-3", "P-4"],
            "order": ["0 125 350", "0 125 350", "350 125 0", "350 125 0"],
            "status": ["completed", "withdrawn", "active", "completed"],
            "valid": [True, False, True, False],
        }
    )
    drawing = progress_drawing(sessions, ["0 125 350", "125 0 350", "350 125 0"])
    (completed,), (opened,) = _traces(drawing, "completed"), _traces(drawing, "open")
    (withdrawn,) = _traces(drawing, "withdrawn or aborted")
    assert completed["x"] == ["0 → 125 → 350", "125 → 0 → 350", "350 → 125 → 0"]
    (not_valid,) = _traces(drawing, "completed, not valid")
    nobody = None
    assert not_valid["y"] == [nobody, nobody, 1]
    assert completed["y"] == [1, nobody, nobody]
    assert (opened["y"], withdrawn["y"]) == ([nobody, nobody, 1], [1, nobody, nobody])


def test_a_confounding_of_limb_and_time_is_stated() -> None:
    """A note states that limb and time are confounded, but only if one limb always came first."""
    counts = {"P-1": {0.0: 1}}
    hand, foot = _phases(counts), _phases(counts, limb="foot").assign(position=2)
    assert "hand phase always came first" in limb_note(pd.concat([hand, foot]))
    turned = pd.concat([hand, foot, hand.assign(position=2), foot.assign(position=1)])
    assert limb_note(turned) == ""


def test_orders_that_share_latencies_are_named_by_their_conditions() -> None:
    """Orders of conditions that share latencies are drawn by the conditions' keys, not in ms."""
    sessions = pd.DataFrame(
        {
            "participant_code": ["P-1", "P-2"],
            "order": ["own female", "own female"],
            "status": ["completed", "active"],
            "valid": [True, False],
        }
    )
    figure = progress_drawing(sessions, ["own female", "female own"]).as_json()
    assert figure is not None
    assert figure["data"][0]["x"] == ["female \u2192 own", "own \u2192 female"]
    assert figure["layout"]["xaxis"]["title"]["text"] == "order of conditions"
    assert " ms" not in figure["data"][0]["hovertemplate"]


def _crossing(code: str, latency: float, **changes: object) -> dict[str, object]:
    row = {
        "participant_code": code,
        "latency_ms": latency,
        "steps_on_s": 3.0,
        "is_across": True,
        "gap_accepted_s": 5.0,
        "waited_s": 2.0,
        "least_post_encroachment_s": 1.5,
        "closest_m": 3.0,
        "collision": False,
    }
    return {**row, **changes}


def test_crossings_are_drawn_as_means_of_each_participant_by_latency() -> None:
    """Two crossings of 4 and 6 s are 5 s; a missing gap and a turn count where they belong."""
    rows = pd.DataFrame(
        [
            _crossing("P1", 0.0, gap_accepted_s=4.0),
            _crossing("P1", 0.0, gap_accepted_s=6.0),
            _crossing("P1", 200.0, gap_accepted_s=None, closest_m=0.0, collision=True),
            _crossing("P1", 200.0, is_across=False, waited_s=99.0, gap_accepted_s=None),
            _crossing("P2", 200.0, gap_accepted_s=7.0),
            # Never on the carriageway.
            _crossing("P3", 0.0, steps_on_s=None, is_across=False),
        ]
    )
    drawings = {one.key: one for one in crossings_drawings(rows)}
    assert list(drawings) == [
        "crossing_gap_accepted_s",
        "crossing_waited_s",
        "crossing_least_post_encroachment_s",
        "crossing_closest_m",
        "crossing_collision",
    ]

    def means(key: str) -> list[tuple[float, float, int]]:
        data = drawings[f"crossing_{key}"].data
        own = data[data["row"] == "mean"]
        return list(zip(own["latency_ms"], own["value"], own["n"], strict=True))

    assert means("gap_accepted_s") == [(0.0, 5.0, 1), (200.0, 7.0, 1)]
    assert means("waited_s") == [(0.0, 2.0, 1), (200.0, 2.0, 2)]
    assert means("closest_m") == [(0.0, 3.0, 1), (200.0, 1.5, 2)]
    # One of the two times that P1 was on the carriageway, none of P2's.
    assert means("collision") == [(0.0, 0.0, 1), (200.0, 0.25, 2)]
    gaps = drawings["crossing_gap_accepted_s"]
    assert gaps.n == 2
    assert "limb" not in gaps.data
    figure = gaps.as_json()
    assert figure is not None
    assert figure["layout"]["yaxis"]["title"]["text"] == "accepted gap (s)"
    assert figure["layout"]["xaxis"]["title"]["text"] == "added latency (ms)"


def test_crossings_that_nobody_has_done_are_said_to_be_missing() -> None:
    """Without a crossing each figure says what is missing."""
    nobody = pd.DataFrame([_crossing("P1", 0.0, steps_on_s=None)])
    for drawing in crossings_drawings(nobody):
        assert drawing.figure is None
        assert drawing.empty == "No participant has a crossing of the road in a finished phase yet."

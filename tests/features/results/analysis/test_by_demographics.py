"""Tests of the figures of scores by demographics, without a database."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
import pytest

from app.features.results.analysis.demographics import variables_of
from app.features.results.analysis.figures import Drawing, demographics_drawings
from tests.science.instruments.helpers import shipped

INSTRUMENTS = {("demographics", 1): shipped("demographics")}
AGES = {"P-1": 20.0, "P-2": 30.0, "P-3": 40.0, "P-4": 50.0}
SCORES = {"P-1": 1.0, "P-2": 2.0, "P-3": 3.0, "P-4": 4.0}


def _answers(item: str, kind: str, given: Mapping[str, float | str]) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {
                "participant_code": code,
                "instrument": "demographics",
                "instrument_version": 1,
                "item": item,
                "item_type": kind,
                "limb": None,
                "block": None,
                "value_number": None if isinstance(value, str) else value,
                "value_text": value if isinstance(value, str) else None,
            }
            for code, value in given.items()
        ]
    )


def _scores(values: dict[str, float]) -> pd.DataFrame:
    """Return agency at two latencies, so that each participant's mean is the given value."""
    return pd.DataFrame(
        [
            {
                "participant_code": code,
                "instrument": "karas2020",
                "score": "agency",
                "limb": "hand",
                "latency_ms": latency_ms,
                "value": value + away,
            }
            for code, value in values.items()
            for latency_ms, away in ((0.0, 1.0), (125.0, -1.0))
        ]
    )


def _agency(*answers: pd.DataFrame) -> Drawing:
    drawings = demographics_drawings(_scores(SCORES), pd.concat(answers), INSTRUMENTS)
    return next(one for one in drawings if one.key == "demographics_agency")


def _figure(drawing: Drawing) -> dict[str, Any]:
    figure = drawing.as_json()
    assert figure is not None, drawing.empty
    return figure


def test_every_participant_is_a_point_at_the_mean_of_their_score() -> None:
    """A number has a panel with its unit, n and ρ, and a point per participant."""
    drawing = _agency(_answers("age", "integer", AGES))
    figure = _figure(drawing)
    (points,) = figure["data"]
    assert (points["x"], points["y"]) == (list(AGES.values()), list(SCORES.values()))
    assert figure["layout"]["annotations"][0]["text"] == "age (years)<br>n = 4, ρ = 1.00"
    assert (drawing.n, drawing.group, drawing.measure) == (4, "demographics", "demographics")


def test_the_ends_of_a_scale_say_what_they_mean() -> None:
    """A rating has a tick for each step of its scale, with the meaning of both ends."""
    rated = _answers("vr_familiarity", "likert", {"P-1": 1.0, "P-2": 2.0, "P-3": 4.0, "P-4": 5.0})
    axis = _figure(_agency(rated))["layout"]["xaxis"]
    assert axis["tickvals"] == [1, 2, 3, 4, 5]
    assert axis["ticktext"] == ["1<br>none", "2", "3", "4", "5<br>very good"]


def test_categories_say_how_many_chose_them_and_have_medians() -> None:
    """A category has its n below it, a place of its own, and a median of three or more."""
    hands = {"P-1": "left", "P-2": "right", "P-3": "right", "P-4": "right"}
    figure = _figure(_agency(_answers("handedness", "choice", hands)))
    points, medians = figure["data"]
    assert figure["layout"]["xaxis"]["ticktext"] == ["left<br>n = 1", "right<br>n = 3"]
    assert [round(place) for place in points["x"]] == [0, 1, 1, 1]
    assert len(set(points["x"])) == 4
    assert (medians["x"], medians["y"]) == ([1], [3.0])


def test_what_everybody_answered_alike_is_named_and_not_drawn() -> None:
    """An answer that everybody gave has no panel; the caption names it."""
    alike = _answers("vision", "boolean", dict.fromkeys(AGES, 1.0))
    drawing = _agency(_answers("age", "integer", AGES), alike)
    assert len(_figure(drawing)["data"]) == 1
    assert drawing.caption.endswith("The same for everybody, so not drawn: vision.")
    assert _agency(alike).figure is None


def test_the_rows_of_the_figure_name_nobody() -> None:
    """The file behind the figure has the points and relations, and no participant's code."""
    data = _agency(_answers("age", "integer", AGES)).data
    assert not any("code" in column for column in data.columns)
    assert not data.isin(list(AGES)).any().any()
    (relation,) = data[data["row"] == "relation"].to_dict("records")
    assert (relation["variable"], relation["effect"], relation["n"]) == ("age (years)", "ρ", 4)
    assert relation["value"] == pytest.approx(1.0)


def test_answers_within_blocks_and_texts_are_no_demographics() -> None:
    """Only what was asked outside the blocks counts, and no free text."""
    in_block = _answers("age", "integer", AGES).assign(limb="hand", block=1)
    text = _answers("occupation", "text", dict.fromkeys(AGES, "teacher"))
    ages = _answers("age", "integer", AGES)
    rows = pd.concat([in_block, text, ages.assign(value_number=1.0), ages])
    (age,) = variables_of(rows, list(AGES), INSTRUMENTS)
    assert (age.heading, age.values.tolist()) == ("age (years)", list(AGES.values()))

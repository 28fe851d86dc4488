"""The internal consistency of questionnaires at each latency and limb."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd

from app.features.results.analysis.material import Material
from app.features.results.analysis.questions.measures import LIMBS, completed
from app.features.results.analysis.questions.words import TestReport, bounded
from app.science.instruments import Instrument
from app.science.statistics import ConstantData, StatisticsError, cronbach_alpha


def reliability(material: Material) -> Iterator[TestReport]:
    """Yield Cronbach's alpha of the scored items of each questionnaire, by cell of the design."""
    tested = completed(material)
    answers = tested.counting(tested.answers)
    ratings = answers[answers["item_type"].eq("likert")].dropna(subset=["limb"])
    for key, own in ratings.groupby("instrument"):
        newest = tested.instruments[str(key), int(own["instrument_version"].max())]
        rows = [
            row
            for limb in LIMBS
            for latency, cell in own[own["limb"] == limb].groupby("latency_ms")
            for row in _alpha_row(newest, limb, f"{latency:g}", cell)
        ]
        if rows:
            yield _alpha_report(newest, rows)


def _alpha_row(
    instrument: Instrument, limb: str, latency: str, cell: pd.DataFrame
) -> Iterator[tuple[str, ...]]:
    wide = cell.pivot_table(index="participant_code", columns="item", values="value_number")
    items = [item for item in instrument.items if item.key in instrument.scored_items]
    columns = [item for item in items if item.key in wide.columns]
    turned = [_turned(wide[item.key], instrument, item.reverse_keyed, item.key) for item in columns]
    if len(turned) < 2:
        return
    try:
        found = cronbach_alpha(np.column_stack(turned))
    except ConstantData as error:
        yield limb, latency, str(len(wide)), str(error), ""
    except StatisticsError:
        return
    else:
        ends = f"[{bounded(found.low, 2)}, {bounded(found.high, 2)}]"
        yield limb, latency, str(found.n), bounded(found.alpha, 2), ends


def _turned(answers: pd.Series, instrument: Instrument, reverse: bool, key: str) -> np.ndarray:  # noqa: FBT001 - of the item
    values = answers.to_numpy(dtype=np.float64)
    scale = instrument.scale_of(instrument.by_key[key])
    return scale.minimum + scale.maximum - values if reverse and scale is not None else values


def _alpha_report(instrument: Instrument, rows: Sequence[tuple[str, ...]]) -> TestReport:
    title: Mapping[str, str] = instrument.title
    reversed_items = [item.key for item in instrument.items if item.reverse_keyed]
    turned = f"after reversing {', '.join(reversed_items)}" if reversed_items else ""
    return TestReport(
        key=f"alpha_{instrument.key}",
        title=f"{title.get('en') or instrument.key}: consistency of its scored items",
        sentence=(
            f"Cronbach’s alpha of {len(instrument.scored_items)} items {turned}. With few "
            "participants the intervals are wide; alpha says nothing about validity."
        ),
        apa="",
        columns=("task", "latency (ms)", "n", "α", "95 % CI"),
        rows=rows,
        method="Alpha with Feldt’s interval; participants with every item.",
        source="Cronbach 1951, Psychometrika 16:297; Feldt 1965, Psychometrika 30:357.",
        exploratory=True,
    )

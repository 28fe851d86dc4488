"""What participants answered about themselves, and how their scores relate to it.

These are the answers that were given once, outside the blocks: age, handedness, how well one knows
virtual reality. Texts are not compared.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from app.science.instruments import Instrument, Item, Scale
from app.science.statistics import Explored, explore

KEY = "demographics"
"""The measure of the statistics page that has the table of these relations."""
MOST_STEPS = 9


@dataclass(frozen=True, eq=False)
class Variable:
    """One answer about the participants, outside the blocks.

    `values`: by participant code, numbers (NaN where missing) or words (None where missing).
    `steps`: the labels of a scale's steps, by value. `words`: of categories, the answers in the
    item's order.
    """

    name: str
    unit: str
    steps: Mapping[float, str]
    values: "pd.Series[float] | pd.Series[str]"
    words: tuple[str, ...] = ()

    @property
    def is_number(self) -> bool:
        """Return whether the answers are numbers, else categories."""
        return not self.words

    @property
    def heading(self) -> str:
        """Return the name with its unit."""
        return f"{self.name} ({self.unit})" if self.unit else self.name

    @property
    def differs(self) -> bool:
        """Return whether participants gave different answers."""
        return int(self.values.nunique()) > 1


def variables_of(
    answers: pd.DataFrame,
    codes: Sequence[str],
    instruments: Mapping[tuple[str, int], Instrument],
) -> list[Variable]:
    """Return the numbers and categories that were asked outside the blocks, numbers first.

    `answers`: valid rows of that table. `codes`: the participants, in the order of the values.
    """
    about = answers[answers["limb"].isna() & answers["block"].isna()]
    found = []
    for (form, key), own in about.groupby(["instrument", "item"], sort=False):
        # The wording may differ between versions; that of the newest is shown.
        instrument = instruments[str(form), int(own["instrument_version"].max())]
        item = instrument.by_key.get(str(key))
        given = own.drop_duplicates("participant_code", keep="last").set_index("participant_code")
        if item is not None and item.type != "text":
            found.append(_variable(instrument, item, given.reindex(list(codes))))
    return sorted(found, key=lambda one: not one.is_number)


def relations_of(scores: "pd.Series[float]", variables: Sequence[Variable]) -> tuple[Explored, ...]:
    """Return the relation of the scores, by participant, to each variable; p adjusted over all."""
    return explore(
        scores.to_numpy(dtype=np.float64),
        {one.heading: one.values.to_numpy(np.float64) for one in variables if one.is_number},
        {
            one.heading: [None if pd.isna(word) else str(word) for word in one.values]
            for one in variables
            if not one.is_number
        },
    )


def _variable(instrument: Instrument, item: Item, given: pd.DataFrame) -> Variable:
    """Return an item's answers; `given` has a row for each participant, in their order."""
    unit = item.unit or ""
    name = item.key.removesuffix(f"_{unit}") if unit else item.key
    name = name.replace("_", " ")
    if item.type == "choice":
        labels = {one.key: one.key.replace("_", " ") for one in item.choices}
        values = given["value_text"].map(labels)
        words = [label for label in labels.values() if (values == label).any()]
        return Variable(name, unit, {}, values, tuple(words) or ("",))
    if item.type == "boolean":
        values = given["value_number"].map({0.0: "no", 1.0: "yes"})
        return Variable(name, unit, {}, values, ("no", "yes"))
    scale = instrument.scale_of(item)
    steps = {} if scale is None else _steps(scale)
    return Variable(name, unit, steps, given["value_number"].astype("float64"))


def _steps(scale: Scale) -> dict[float, str]:
    """Return the label of every step of a short scale, with the meaning of its ends."""
    steps = scale.steps if len(scale.steps) <= MOST_STEPS else (scale.minimum, scale.maximum)
    labels = {float(step): str(step) for step in steps}
    if scale.labels:
        for end, label in ((scale.minimum, scale.labels[0]), (scale.maximum, scale.labels[-1])):
            labels[float(end)] = f"{end}<br>{label.get('en', '')}"
    return labels

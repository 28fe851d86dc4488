"""What participants answered about themselves, and how their scores relate to it.

These are the answers that were given once, outside the blocks: age, handedness, how well one knows
virtual reality. Texts are not compared.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from app.science.instruments import Instrument, Item
from app.science.statistics import Explored, explore

KEY = "demographics"
"""The measure of the statistics page that has the table of these relations."""


@dataclass(frozen=True, eq=False)
class Variable:
    """One answer about the participants, outside the blocks.

    `values`: by participant code, numbers (NaN where missing) or words (None where missing).
    `ends`: what the ends of its scale mean. `words`: of categories, the answers in the item's
    order.
    """

    name: str
    unit: str
    ends: str
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
        return Variable(name, unit, "", values, tuple(words) or ("",))
    if item.type == "boolean":
        values = given["value_number"].map({0.0: "no", 1.0: "yes"})
        return Variable(name, unit, "", values, ("no", "yes"))
    scale = instrument.scale_of(item)
    ends = ""
    if scale is not None and scale.labels:
        low, high = (label.get("en", "") for label in (scale.labels[0], scale.labels[-1]))
        ends = f"{scale.minimum} {low} – {scale.maximum} {high}"
    return Variable(name, unit, ends, given["value_number"].astype("float64"))

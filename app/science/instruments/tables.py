"""Scores of a table of people, one row for each filled-in form.

Apart from `scoring` because of pandas, which a server that scores single forms need not load.
"""

import numpy as np
import pandas as pd

from app.science.instruments.answers import as_number
from app.science.instruments.columns import item_columns
from app.science.instruments.errors import InstrumentTableError
from app.science.instruments.evaluation import FloatArray
from app.science.instruments.model import Instrument, Item
from app.science.instruments.scoring import scores_of_columns


def score_table(instrument: Instrument, frame: pd.DataFrame) -> pd.DataFrame:
    """Scores of a table with one row for each filled-in form.

    `frame`: columns named like items (q1 or Q1) hold raw answers, as numbers or as text; all others
    are ids. Returns the ids as they are, then one float column for each score (NaN: no value), with
    the same index. A missing item column empties just the scores that need it.

    Raises AnswerError with the row (from 1) for an answer off its scale; InstrumentTableError if no
    column is an item, if a column is there twice, or if an id is named like a score.
    """
    named = item_columns(instrument, [str(name) for name in frame.columns])
    columns = {
        key: _numbers(instrument, instrument.by_key[key], frame.iloc[:, position])
        for key, position in named.items()
        if instrument.by_key[key].is_numeric
    }
    items = set(named.values())
    ids = frame.iloc[:, [at for at in range(frame.shape[1]) if at not in items]]
    clash = [score.key for score in instrument.scores if score.key in ids.columns]
    if clash:
        raise InstrumentTableError(
            f"The table already has a column {clash[0]!r}, which is the name of a score. "
            "Rename or remove that column."
        )
    scores = scores_of_columns(instrument, columns, rows=len(frame))
    return pd.concat([ids, pd.DataFrame(scores, index=frame.index, dtype=np.float64)], axis=1)


def _numbers(instrument: Instrument, item: Item, column: "pd.Series[float]") -> FloatArray:
    return np.array(
        [
            as_number(instrument, item, _cell(value), row=row)
            for row, value in enumerate(column.tolist(), start=1)
        ],
        dtype=np.float64,
    )


_MISSING = frozenset({"", "na", "n/a", "nan", "null", "none"})
_YES_NO = {"true": True, "yes": True, "false": False, "no": False}


def _cell(value: object) -> object:
    """Text of a table as a number where it is one; the usual words for "missing" as None."""
    if value is pd.NA:
        return None
    if not isinstance(value, str):
        return value
    text = value.strip().lower()
    if text in _MISSING:
        return None
    if text in _YES_NO:
        return _YES_NO[text]
    # float() would also take "1_0", "inf" and digits of other scripts.
    if text.isascii() and "_" not in text and any(letter.isdigit() for letter in text):
        try:
            return float(text)
        except ValueError:
            return value
    return value

"""Find scales that seem to be numbered differently, and items that seem to be reversed already."""

from collections.abc import Mapping as Map
from collections.abc import Sequence

from app.features.results.imports.applying import Form
from app.features.results.imports.schemas import Shift
from app.science.instruments import Instrument, reversal_doubts


def shift_of(instrument: Instrument, numbers: Map[str, Sequence[float]]) -> Shift | None:
    """Return the conversion to the scale if the file seems to count its steps from 0 or 1."""
    found = []
    for key, values in numbers.items():
        scale = instrument.scale_of(instrument.by_key[key])
        if scale is not None and values:
            found.append((scale, min(values), max(values), all(v.is_integer() for v in values)))
    if not found or not all(whole for *_, whole in found):
        return None
    scale = found[0][0]
    if any((one.minimum, one.maximum, one.step) != (scale.minimum, scale.maximum, scale.step)
           for one, *_ in found):  # fmt: skip
        return None
    low, high = min(low for _, low, _, _ in found), max(high for _, _, high, _ in found)
    n = len(scale.steps)
    for start in (1, 0):
        multiply, add = float(scale.step), float(scale.minimum - scale.step * start)
        if (multiply, add) != (1.0, 0.0) and start <= low and high <= n - 1 + start:
            why = (
                f"The numbers range from {low:g} to {high:g}; the scale has {n} steps from "
                f"{scale.minimum} to {scale.maximum}. The file may count the steps from {start}."
            )
            return Shift(multiply=multiply, add=add, why=why)
    return None


def reversal_notes(turning: Map[str, tuple[str, list[str]]], forms: Sequence[Form]) -> list[str]:
    """Return notes on items that correlate positively with items that they should oppose."""
    return [
        f"{doubt}. If the file has already reversed it, mark it as reversed."
        for doubt in reversal_doubts(turning, [form.answers for form in forms])
    ]

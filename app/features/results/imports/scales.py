"""Guess the scale of answers from the answers that a file contains, and say what speaks against it.

A file shows only which answers were given, not which could have been. So the ends of a scale are a
guess until a person has compared them with the questionnaire, and the guess comes with what makes
it doubtful: answers that are all the same, only two different ones, a number that usually stands
for a missing answer, words that are on several scales.
"""

from collections.abc import Collection, Sequence
from collections.abc import Mapping as Map
from typing import Final

from app.features.results.imports.schemas import Shift
from app.science.instruments import USUAL_MISSING_CODES, Instrument

AGREEMENT: Final[Sequence[Sequence[str]]] = tuple(
    tuple(words.split(", "))
    for words in (
        "strongly disagree, disagree, neither agree nor disagree, agree, strongly agree",
        "strongly disagree, disagree, neutral, agree, strongly agree",
        "strongly disagree, disagree, undecided, agree, strongly agree",
        "strongly disagree, disagree, neither disagree nor agree, agree, strongly agree",
        (
            "strongly disagree, disagree, somewhat disagree, neither agree nor disagree, somewhat"
            " agree, agree, strongly agree"
        ),
        (
            "strongly disagree, disagree, somewhat disagree, neutral, somewhat agree, agree,"
            " strongly agree"
        ),
        "not at all, slightly, moderately, very, extremely",
        "never, rarely, sometimes, often, always",
        "stimme gar nicht zu, stimme eher nicht zu, weder noch, stimme eher zu, stimme zu",
        "stimme gar nicht zu, stimme eher nicht zu, neutral, stimme eher zu, stimme voll zu",
        "stimme gar nicht zu, stimme eher nicht zu, teils/teils, stimme eher zu, stimme voll zu",
    )
)
"""Scales whose words have an order that is known, from lowest to highest; numbered from 1."""
ENDS: Final = {0: (1, 4, 6, 10, 20, 100), 1: (5, 7, 9, 10, 11, 21, 100)}
"""Lowest answer -> the highest ones that scales beginning there usually have."""
USUAL_HIGH: Final = 11
_GAP = 5


def scales_with(words: Collection[str]) -> list[tuple[str, ...]]:
    """Return the known scales that have all of these words, in lower case; none without words."""
    return [tuple(scale) for scale in AGREEMENT if words and set(words) <= set(scale)]


def usual_ends(numbers: Collection[int]) -> tuple[int, int]:
    """Return the ends of the usual scale that these numbers fit best."""
    least, most = min(numbers), max(numbers)
    if least < 0:
        return -max(-least, most), max(-least, most)
    low = min(least, 1)
    return low, next((high for high in ENDS[low] if most <= high), most)


def missing_codes(numbers: Collection[int]) -> list[int]:
    """Return those numbers that usually stand for a missing answer and are far from all others.

    The others must be answers on a usual scale, so that 99 among ages is no code.
    """
    codes = sorted(USUAL_MISSING_CODES & set(numbers))
    answers = set(numbers) - USUAL_MISSING_CODES
    if not codes or not answers or min(answers) < 0 or max(answers) > USUAL_HIGH:
        return []
    return [code for code in codes if code < 0 or code > max(answers) + _GAP]


def doubts_about(numbers: Collection[int], words: Collection[str]) -> list[str]:
    """Return what makes a scale that was guessed from these answers doubtful, as sentences."""
    doubts = []
    if len(numbers) == 1 or len(words) == 1:
        only = next(iter(numbers or words))
        doubts.append(f"Every answer is {only}, so the file says nothing about the scale.")
    elif set(numbers) == {0, 1}:
        doubts.append(
            "Only 0 and 1 were seen: answers of yes or no, or a longer scale of which only these"
            " were used."
        )
    codes = missing_codes(numbers)
    if codes:
        doubts.append(
            f"{_listed(codes)} is far from all other answers and usually stands for a missing one:"
            " empty these cells before the columns are read."
        )
    lengths = sorted({len(scale) for scale in scales_with(words)})
    if len(lengths) > 1 and len(words) < lengths[0]:
        doubts.append(
            f"These words are on scales of {' and of '.join(map(str, lengths))} steps; the shorter"
            " one is taken."
        )
    return doubts


def why_not_offered(values: Sequence[str], numbers: Collection[int] | None) -> str | None:
    """Return why a column that could be an item is left out; None if it does not look like one.

    Args:
        values: its cells with a value.
        numbers: the whole numbers they are; None if some cell is something else.
    """
    if numbers is not None:
        codes = missing_codes(numbers)
        if not codes:
            return None
        count = sum(_whole(value) in codes for value in values)
        rest = set(numbers) - set(codes)
        return (
            f"{_listed(codes)} in {count} {'cell' if count == 1 else 'cells'}, all others"
            f" {min(rest)} to {max(rest)}: if it means a missing answer, empty these cells"
        )
    words = {value.casefold(): value for value in reversed(values)}
    in_words = not any(any(letter.isdigit() for letter in value) for value in values)
    repeated = len(words) < len(values) or any(scales_with({word}) for word in words)
    if not (in_words and repeated and len(words) <= USUAL_HIGH and max(map(len, words)) <= 60):
        return None
    seen = ", ".join(f"“{one}”" for one in words.values())
    if scales_with(words):
        return f"words of another scale than the offered one: {seen}"
    return f"words that no known scale has: {seen}; replace them with numbers to have it offered"


def _whole(value: str) -> int | None:
    try:
        return int(float(value.replace(",", ".")))
    except ValueError:
        return None


def _listed(codes: Sequence[int]) -> str:
    return " or ".join(map(str, codes))


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

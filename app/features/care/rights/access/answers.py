"""An answer as the participant saw it: the words they chose, not the number that was stored."""

from collections.abc import Mapping

from app.features.care.rights.access.words import in_language
from app.science.instruments import Instrument, Item


def answer_text(
    instrument: Instrument,
    item: Item,
    value: object,
    language: str,
    words: Mapping[str, str],
) -> str:
    """The answer in words, with its number where there is one."""
    if value is None:
        return words["left_out"]
    if item.type == "choice":
        labels = {choice.key: in_language(choice.label, language) for choice in item.choices}
        return labels.get(str(value), str(value))
    if isinstance(value, str):
        return value
    number = float(str(value))
    if item.type == "boolean":
        return words["yes"] if number else words["no"]
    label = _scale_label(instrument, item, number, language)
    unit = f" {item.unit}" if item.unit else ""
    return f"{number:g}{unit}" + (f" ({label})" if label else "")


def _scale_label(instrument: Instrument, item: Item, number: float, language: str) -> str:
    """The words at this step of a scale, where it has words for every step or at its ends."""
    scale = instrument.scale_of(item)
    if scale is None or not scale.labels:
        return ""
    steps = list(scale.steps)
    if len(scale.labels) == len(steps):
        named = dict(zip(steps, scale.labels, strict=True))
    else:
        named = {steps[0]: scale.labels[0], steps[-1]: scale.labels[-1]}
    found = named.get(int(number)) if number == int(number) else None
    return "" if found is None else in_language(found, language)

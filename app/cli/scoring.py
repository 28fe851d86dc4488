"""Score a table of answers, or offer an instrument for it, from the command line."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.cli.outputs import require_output
from app.protocol import load_instrument
from app.resources import study_configs_dir
from app.science.instruments.table import Scored, scored_csv
from app.whole_files import write_whole


def score_file(answers: Path, instrument_key: str, missing: Collection[str] = ()) -> Scored:
    """Return the scored table, with notes on scores that have no value.

    Raises ValueError or OSError if the input is unusable.

    The instrument is one of the product's, by its key, or a file of its own; `missing` are codes
    that stand for a missing answer.
    """
    folder = study_configs_dir() / "instruments"
    by_key = {path.stem: path for path in sorted(folder.glob("*.yaml"))}
    file = by_key.get(instrument_key, Path(instrument_key))
    if not file.is_file():
        raise ValueError(
            f"there is no instrument {instrument_key!r}, and no such file; there are:"
            f" {', '.join(by_key)}"
        )
    loaded = load_instrument(file.read_text(encoding="utf-8"))
    return scored_csv(loaded.instrument, _text_of(answers), missing)


@dataclass(frozen=True)
class OfferOrder:
    """The options of the command `instrument`: what a person says of the questionnaire."""

    answers: Path
    key: str | None
    title: str | None
    minimum: int | None
    maximum: int | None
    language: str
    out: Path | None


def offer_instrument(order: OfferOrder) -> dict[str, Any]:
    """Return what the columns of a table are, and the file of an instrument for its answers.

    Keys: `rows`, `columns`; `known`: the instrument of the product that fits, if one does; `read`:
    the columns that it and the participants take; `offer`: the offered instrument, or None;
    `left_out`: columns that nothing takes, with the number of filled cells; `written`.

    Raises ValueError or ReembodyError for unusable input, OSError if it cannot be written.
    """
    from app.features.results.imports import offer, offered_file, read_columns

    require_output(order.out, order.answers)
    text = _text_of(order.answers)
    known = {
        path.stem: load_instrument(path.read_text(encoding="utf-8")).instrument
        for path in sorted((study_configs_dir() / "instruments").glob("*.yaml"))
    }
    seen = read_columns(text, known)
    offered, left_out = offer(seen.sheet, seen.used, known)
    written = None
    if offered is not None:
        edits = {
            "key": order.key,
            "title": order.title,
            "minimum": order.minimum,
            "maximum": order.maximum,
        }
        given = {name: value for name, value in edits.items() if value is not None}
        confirmed = {f"guessed_{end}": None for end in ("minimum", "maximum") if end in given}
        offered = offered.model_copy(update={**given, **confirmed})
        content = offered_file(offered, order.language, known)
        load_instrument(content)
        if order.out is not None:
            write_whole(order.out, content)
            written = str(order.out)
    elif order.out is not None:
        reasons = "".join(f"; {one.name}: {one.reason}" for one in left_out if one.reason)
        raise ValueError(
            f"{order.answers}: no column looks like an answer to an unknown questionnaire, so"
            f" there is no instrument to write to {order.out}{reasons}"
        )
    return {
        "rows": len(seen.sheet.rows),
        "columns": len(seen.sheet.header),
        "known": seen.instrument,
        "read": sorted(seen.used, key=seen.sheet.header.index),
        "offer": None if offered is None else offered.model_dump(),
        "left_out": [one.model_dump() for one in left_out],
        "written": written,
    }


def offer_text(found: dict[str, Any]) -> str:
    """Format the result of `offer_instrument` for people."""
    lines = [f"{found['rows']} rows, {found['columns']} columns."]
    if found["known"] is not None:
        lines.append(f"Answers to {found['known']}: {', '.join(found['read'])}")
    elif found["read"]:
        lines.append(f"Participants and conditions: {', '.join(found['read'])}")
    offered = found["offer"]
    if offered is not None:
        lines.append(
            f"Offered as {offered['key']} ({offered['title']}), {offered['minimum']} to"
            f" {offered['maximum']}; answers seen: {offered['seen']}."
        )
        guesses = [end for end in ("minimum", "maximum") if offered[f"guessed_{end}"] is not None]
        if guesses:
            named = " and ".join(f"its {end} of {offered[end]}" for end in guesses)
            options = " and ".join(f"--{end}" for end in guesses)
            lines.append(
                f"The scale is a guess: {named} {'follows' if len(guesses) == 1 else 'follow'} from"
                f" the answers seen. Confirm with {options}, as the questionnaire has them."
            )
        lines += [f"  {doubt}" for doubt in offered["doubts"] if guesses]
        lines += [f"  {one['key']:<24}{one['text']}" for one in offered["items"]]
    if found["left_out"]:
        names = ", ".join(f"{one['name']} ({one['filled']})" for one in found["left_out"])
        lines.append(f"Left out, with their filled cells: {names}")
        lines += [
            f"  {one['name']}: {one['reason']}" for one in found["left_out"] if one.get("reason")
        ]
    if found["written"]:
        lines.append(f"Written: {found['written']}")
    elif offered is not None:
        lines.append("--out FILE writes its file.")
    return "\n".join(lines)


def _text_of(answers: Path) -> str:
    try:
        return answers.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{answers} is not UTF-8 text; save it as CSV UTF-8") from error

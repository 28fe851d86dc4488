"""Which columns of a table hold which item."""

from collections import Counter
from collections.abc import Sequence

from app.science.instruments.errors import InstrumentTableError
from app.science.instruments.model import Instrument


def item_columns(instrument: Instrument, headers: Sequence[str]) -> dict[str, int]:
    """Item key -> position of its column. Capitals and blanks around a header do not matter.

    Raises InstrumentTableError if a column is there twice or if no column is an item.
    """
    names = [item_name(instrument, header) for header in headers]
    doubled = [name for name, count in Counter(names).items() if count > 1]
    if doubled:
        places = ", ".join(str(at + 1) for at, name in enumerate(names) if name == doubled[0])
        raise InstrumentTableError(
            f"The column {doubled[0]!r} is there more than once (columns {places}). "
            "Keep the right one and remove the others."
        )
    found = {name: at for at, name in enumerate(names) if name in instrument.by_key}
    if not found:
        keys = ", ".join(instrument.by_key)
        given = ", ".join(headers) or "none"
        raise InstrumentTableError(
            f"No column is an item of {instrument.key}: the columns are {given}. "
            f"Name the answer columns after the items: {keys}."
        )
    return found


def item_name(instrument: Instrument, header: str) -> str:
    """The item that a header means; other headers stay as they are."""
    name = header.strip()
    return name.lower() if name.lower() in instrument.by_key else header

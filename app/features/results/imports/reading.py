"""A file read by what was said of it, against the lab's instruments and the study's conditions."""

from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotFound
from app.features.design.instruments.service import parsed_instruments
from app.features.design.studies.service import newest_version, protocol_of
from app.features.results.imports.applying import Applied, apply_mapping
from app.features.results.imports.schemas import Mapping
from app.features.results.imports.sheet import read_sheet
from app.models import Study
from app.science.instruments import Instrument


def applied_to(
    db: Session, study: Study, text: str, mapping: Mapping
) -> tuple[Instrument, Applied]:
    """The instrument and the forms; raises InvalidInput for unknown items, conditions, columns."""
    instrument = known_instrument(parsed_instruments(db), mapping.instrument)
    for item in [*(key for one in mapping.sets for key in one.items), *mapping.turned]:
        if item not in instrument.by_key:
            raise InvalidInput(
                f"the instrument {instrument.key!r} has no item {item!r}",
                value=item,
                valid=list(instrument.by_key),
            )
    keys = frozenset(one.key for one in protocol_of(newest_version(db, study)).conditions)
    unknown = sorted(set(mapping.conditions.values()) - keys)
    if unknown:
        raise InvalidInput(
            f"the study has no condition {unknown[0]!r}", value=unknown[0], valid=sorted(keys)
        )
    sheet = read_sheet(text, mapping.header_rows)
    return instrument, apply_mapping(sheet, mapping, instrument, keys)


def known_instrument(instruments: dict[str, Instrument], key: str) -> Instrument:
    """The instrument of that key; raises NotFound."""
    if key not in instruments:
        raise NotFound(f"there is no instrument {key!r}", value=key, valid=sorted(instruments))
    return instruments[key]

"""Parse and cache the content of stored study versions, which never change."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import NotFound
from app.features.design.instruments import instrument_of
from app.models import InstrumentVersion, StudyVersion
from app.platform.config_problems import unpacking
from app.platform.immutable_cache import ImmutableCache
from app.protocol import StudyProtocol, parse_study_json
from app.science.instruments import Instrument

_VERSIONS, _INSTRUMENTS = 64, 512


@dataclass(frozen=True)
class VersionContent:
    """The content of a study version; `instruments`: key -> hash of the wording it uses."""

    protocol: StudyProtocol
    instruments: Mapping[str, str]


@dataclass(frozen=True)
class UsedInstrument:
    """The wording that a study version uses: its row's id, parsed, and as JSON for a page."""

    version_id: str
    instrument: Instrument
    definition: Mapping[str, Any]


_contents: ImmutableCache[str, VersionContent] = ImmutableCache(_VERSIONS)
_used: ImmutableCache[tuple[str, str], UsedInstrument] = ImmutableCache(_INSTRUMENTS)


def version_content(db: Session, version_id: str) -> VersionContent:
    """Return the content of a study version that exists."""
    return _contents.get(db, version_id, lambda: _read_content(db, version_id))


def used_instrument(db: Session, version_id: str, key: str) -> UsedInstrument:
    """Return the wording of instrument `key` in a study version; raise NotFound if it uses none."""
    return _used.get(db, (version_id, key), lambda: _read_used(db, version_id, key))


def _read_content(db: Session, version_id: str) -> VersionContent:
    version = referenced_row(db, StudyVersion, version_id)
    with unpacking(version.canonical_json, version.content_hash):
        protocol = parse_study_json(version.canonical_json)
    return VersionContent(protocol, dict(version.instruments))


def _read_used(db: Session, version_id: str, key: str) -> UsedInstrument:
    instruments = version_content(db, version_id).instruments
    row = db.scalar(
        select(InstrumentVersion).where(
            InstrumentVersion.key == key,
            InstrumentVersion.content_hash == instruments.get(key),
        )
    )
    if row is None:
        raise NotFound(
            f"the study uses no instrument {key!r}", value=key, valid=sorted(instruments)
        )
    return UsedInstrument(row.id, instrument_of(row), json.loads(row.canonical_json))

"""Check that the study, its instruments and its avatar are stored unchanged and translated."""

from app.database import referenced_row
from app.errors import ReembodyError
from app.features.design.instruments import instrument_of
from app.features.design.studies import instrument_for, protocol_of
from app.features.movement.avatar import configuration_by_hash
from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.features.record.sessions import plan_of
from app.models import StudyVersion
from app.protocol import sha256_of
from app.science.avatar.configuration import missing_part_problems
from app.texts import Words

SHORT = 12
"""How many hexadecimal digits of a hash are shown for people to compare."""
_RESTORE = Words(
    en="The database was changed by hand. Restore it from a backup.",
    de="Die Datenbank wurde von Hand geändert. Stellen Sie sie aus einer Sicherung wieder her.",
)


def _version(situation: Situation) -> StudyVersion:
    return referenced_row(situation.db, StudyVersion, situation.session.study_version_id)


def _instruments(situation: Situation) -> Found:
    """Check that every instrument is unchanged since the study adopted it, and can be parsed."""
    db, version = situation.db, _version(situation)
    intact: list[str] = []
    damaged: list[str] = []
    for key in sorted(version.instruments):
        try:
            row = instrument_for(db, version, key)
            number = instrument_of(row).version
        except (ReembodyError, ValueError):
            damaged.append(key)
            continue
        if sha256_of(row.canonical_json) == row.content_hash:
            intact.append(f"{key} v{number} {row.content_hash[:SHORT]}")
        else:
            damaged.append(key)
    if damaged:
        return Found("damaged", value=len(damaged), unit="instruments", details=tuple(damaged))
    return Found(
        "ok" if intact else "none", value=len(intact), unit="instruments", details=tuple(intact)
    )


INSTRUMENTS = StateCheck(
    key="instruments",
    title=Words(en="Instruments", de="Instrumente"),
    findings=(
        Finding(
            "damaged",
            "fail",
            Words(
                en="{{value}} changed since they were saved",
                de="{{value}} seit dem Speichern verändert",
            ),
            remedy=_RESTORE,
        ),
        Finding("none", "unneeded", Words(en="The study has none", de="Die Studie hat keine")),
        Finding("ok", "ok", Words(en="{{value}} unchanged", de="{{value}} unverändert")),
    ),
    run=_instruments,
)


def _configuration(situation: Situation) -> Found:
    """Check that the content of the study, and of any avatar, matches the recorded hashes."""
    db, session, version = situation.db, situation.session, _version(situation)
    details = [f"study v{version.number} {version.content_hash[:SHORT]}"]
    if sha256_of(version.canonical_json) != version.content_hash:
        return Found("differs", details=tuple(details))
    if session.avatar_configuration_hash is None:
        return Found("ok", details=tuple(details))
    details.append(f"avatar {session.avatar_configuration_hash[:SHORT]}")
    try:
        configuration = configuration_by_hash(db, session.avatar_configuration_hash)
    except (ReembodyError, ValueError):
        return Found("differs", details=tuple(details))
    for missing in missing_part_problems(configuration):
        return Found("incomplete", details=(*details, missing.message))
    return Found("ok", details=tuple(details))


CONFIGURATION = StateCheck(
    key="configuration",
    title=Words(en="Configuration", de="Konfiguration"),
    findings=(
        Finding(
            "differs",
            "fail",
            Words(en="Changed since it was saved", de="Seit dem Speichern verändert"),
            remedy=_RESTORE,
        ),
        Finding(
            "incomplete",
            "fail",
            Words(
                en="The avatar lacks parts of the body",
                de="Dem Avatar fehlen Teile des Körpers",
            ),
            remedy=Words(
                en="Save a version of the avatar in which these parts have all their axes, name it "
                "in a new version of the study, and start the session with that.",
                de="Speichern Sie eine Version des Avatars, in der diese Teile alle ihre Achsen "
                "haben, nennen Sie sie in einer neuen Version der Studie und beginnen Sie die "
                "Sitzung damit.",
            ),
        ),
        Finding("ok", "ok", Words(en="Unchanged", de="Unverändert")),
    ),
    run=_configuration,
)


def _language(situation: Situation) -> Found:
    """Check that every text of the study and every instrument exists in the session's language."""
    db, session, version = situation.db, situation.session, _version(situation)
    language = session.language
    texts = {f"text {key}": text for key, text in protocol_of(version).texts.items()}
    texts |= {f"step {step.key}": step.title for step in plan_of(db, session)}
    missing = [name for name, text in texts.items() if not text.get(language, "").strip()]
    for key in version.instruments:
        try:
            languages = instrument_of(instrument_for(db, version, key)).languages
        except (ReembodyError, ValueError):
            continue  # The check of the instruments reports this.
        if language not in languages:
            missing.append(f"instrument {key}")
    if missing:
        return Found("missing", value=len(missing), unit="texts", details=(language, *missing))
    count = len(texts) + len(version.instruments)
    return Found("ok", value=count, unit="texts", details=(language,))


LANGUAGE = StateCheck(
    key="language",
    title=Words(en="Language", de="Sprache"),
    findings=(
        Finding(
            "missing",
            "fail",
            Words(en="{{value}} texts missing", de="{{value}} Texte fehlen"),
            remedy=Words(
                en="Add the texts in a new version of the study, or run the session in another "
                "language.",
                de="Ergänzen Sie die Texte in einer neuen Version der Studie oder führen Sie die "
                "Sitzung in einer anderen Sprache durch.",
            ),
        ),
        Finding(
            "ok",
            "ok",
            Words(en="{{value}} texts are available", de="{{value}} Texte sind vorhanden"),
        ),
    ),
    run=_language,
)

"""HTTP endpoints of imported answers: preview, check, import, list, undo and erase."""

from collections.abc import Iterator
from contextlib import contextmanager

from fastapi import APIRouter, Response
from sqlalchemy.orm import Session

from app.errors import ReembodyError
from app.features.design.instruments import parsed_instruments, save_instrument
from app.features.design.studies import newest_version, protocol_of, study_by_key
from app.features.people.audit import download_place, record, record_copy
from app.features.record.erasure import clear_erasure_mark, mark_erasure, overwrite
from app.features.results.imports.offering import offered_file
from app.features.results.imports.previewing import check, look
from app.features.results.imports.repository import (
    as_csv,
    forms_of,
    import_by_id,
    import_view,
    imports_of,
    instrument_of_import,
)
from app.features.results.imports.schemas import (
    CheckRequest,
    CheckView,
    ErasedImported,
    EraseImportedRequest,
    ImportDetail,
    ImportRequest,
    ImportView,
    LookedInstrument,
    LookRequest,
    LookView,
    OfferedInstrument,
    UndoRequest,
)
from app.features.results.imports.service import erase_imported, import_answers, undo
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn, Writing

router = APIRouter(tags=["imports"], prefix="/studies/{key}/imports")


@router.post("/look")
def post_look(key: str, request: LookRequest, db: Reading, _: SignedIn) -> LookView:
    """Preview a file and propose what its columns mean; nothing is stored."""
    return look(db, study_by_key(db, key), request)


@router.post("/check")
def post_check(key: str, request: CheckRequest, db: Reading, _: SignedIn) -> CheckView:
    """Report the result that an import would have, with every invalid cell; nothing is stored."""
    return check(db, study_by_key(db, key), request.text, request.mapping)


@router.post("/instrument", status_code=201)
def post_offered_instrument(
    key: str, request: OfferedInstrument, db: Writing, context: Context, caller: SignedIn
) -> LookedInstrument:
    """Store an offered instrument, as a person has edited it, under a key that is still free."""
    protocol = protocol_of(newest_version(db, study_by_key(db, key)))
    known = frozenset(parsed_instruments(db))
    text = offered_file(request, protocol.languages[0], known)
    now = context.clock.utc_now()
    row = save_instrument(db, text, now)
    record(
        db,
        actor=caller.actor,
        action="answer.instrument_made",
        subject=f"instrument:{row.key}",
        details={"study": key, "items": len(request.items)},
        now=now,
    )
    return LookedInstrument(instrument=row.key)


@router.post("", status_code=201)
def post_import(
    key: str, request: ImportRequest, db: Writing, context: Context, caller: SignedIn
) -> ImportView:
    """Import a file: all of its forms, or none."""
    study = study_by_key(db, key)
    now = context.clock.utc_now()
    return import_view(db, import_answers(db, study, request, actor=caller.actor, now=now))


@router.get("")
def get_imports(key: str, db: Reading, _: SignedIn) -> list[ImportView]:
    """Return every import of a study, newest first, including those that were undone."""
    return [import_view(db, row) for row in imports_of(db, study_by_key(db, key))]


@router.get("/{import_id}")
def get_import(key: str, import_id: str, db: Reading, _: SignedIn) -> ImportDetail:
    """Return one import with the results of its scores."""
    # Imported here because it loads scipy, which would slow down the server's start.
    from app.features.results.imports.results import results_of

    row = import_by_id(db, study_by_key(db, key), import_id)
    results = results_of(instrument_of_import(db, row), forms_of(db, row))
    return ImportDetail(view=import_view(db, row), results=results)


@router.get(
    "/{import_id}/table",
    response_class=Response,
    responses={200: {"content": {"text/csv": {}}, "description": "Forms, answers and scores."}},
)
def get_import_table(
    key: str, import_id: str, db: Writing, context: Context, caller: SignedIn
) -> Response:
    """Return the forms of an import as CSV; every row is marked as imported."""
    study = study_by_key(db, key)
    row = import_by_id(db, study, import_id)
    body = as_csv(study, instrument_of_import(db, row), row, forms_of(db, row)).encode()
    now = context.clock.utc_now()
    # People's data leave the database, so the copy is recorded for a later erasure.
    record_copy(
        db,
        kind="export",
        study_id=study.id,
        session_kind="people",
        place=f"{download_place(caller.actor)}: imported answers {row.id}",
        by=caller.actor,
        now=now,
        sessions=0,
        size_bytes=len(body),
    )
    record(
        db,
        actor=caller.actor,
        action="study.exported",
        subject=f"study:{study.key}",
        details={"import": row.id},
        now=now,
    )
    name = f"{key}_imported_{row.instrument}_{row.id[:8]}.csv"
    return Response(
        body,
        media_type="text/csv; charset=utf-8",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


@router.post("/{import_id}/undo")
def post_undo(
    key: str, import_id: str, request: UndoRequest, context: Context, caller: SignedIn
) -> ImportView:
    """Delete the forms of an import; keep the import with who undid it and why."""
    with _erasing(context) as db:
        study = study_by_key(db, key)
        row = import_by_id(db, study, import_id, lock=True)
        now = context.clock.utc_now()
        undo(db, row, reason=request.reason, actor=caller.actor, now=now)
    with context.database.reading() as db:
        return import_view(db, import_by_id(db, study_by_key(db, key), import_id))


@router.post("/erase")
def post_erase_imported(
    key: str, request: EraseImportedRequest, context: Context, caller: SignedIn
) -> ErasedImported:
    """Erase one participant's answers from all imports of a study."""
    with _erasing(context) as db:
        erased_forms = erase_imported(
            db,
            study_by_key(db, key),
            request.participant_code,
            confirm=request.confirm,
            actor=caller.actor,
            now=context.clock.utc_now(),
        )
    return ErasedImported(forms=erased_forms)


@contextmanager
def _erasing(context: AppContext) -> Iterator[Session]:
    """Open a transaction that deletes people's answers, then overwrite the freed bytes."""
    new = mark_erasure(context.settings)
    try:
        with context.database.writing() as db:
            yield db
    except ReembodyError:
        if new:
            clear_erasure_mark(context.settings)
        raise
    overwrite(context.database, context.settings)

"""HTTP endpoints that start, show and stop a scripted participant."""

from fastapi import APIRouter

from app.errors import InvalidInput, NotFound
from app.features.design.studies import newest_version, protocol_of, require_open, study_by_key
from app.features.record.tryout.runner import TryoutRunner, TryoutView, TryoutWish
from app.platform.access import Caller, require_object
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(tags=["tryout"])


@router.post("/studies/{key}/tryout", status_code=202)
def post_tryout(
    key: str, wish: TryoutWish, db: Reading, context: Context, caller: SignedIn
) -> TryoutView:
    """Send a scripted participant through the study, in a session marked as simulated."""
    study = study_by_key(db, key)
    require_open(study)
    context.storage.require_storage()
    languages = protocol_of(newest_version(db, study)).languages
    if wish.language not in languages:
        raise InvalidInput(
            f"this study has no texts in the language {wish.language!r}",
            value=wish.language,
            valid=list(languages),
            remedy="Choose one of the study's languages.",
        )
    url = context.network.reach.local_url
    return context.part(TryoutRunner).begin(caller, study.key, wish.language, url)


@router.get("/tryout")
def get_tryout(context: Context, caller: SignedIn) -> TryoutView | None:
    """Return the latest scripted participant; null if there was none since the server started."""
    newest = context.part(TryoutRunner).newest(caller)
    return newest if newest is not None and _sees(context, caller, newest) else None


@router.delete("/tryout")
def delete_tryout(context: Context, caller: SignedIn) -> TryoutView:
    """Stop the scripted participant that is running, and end its session."""
    newest = context.part(TryoutRunner).newest(caller)
    if newest is None or not _sees(context, caller, newest):
        raise NotFound("no scripted participant is running", remedy="Start another one.")
    return context.part(TryoutRunner).call_off(caller)


def _sees(context: AppContext, caller: Caller, tryout: TryoutView) -> bool:
    """Return whether the scripted participant's study is visible to the caller."""
    with context.database.reading() as db:
        try:
            require_object(db, caller, "/api/studies/{key}", {"key": tryout.study_key})
        except NotFound:
            return False
    return True

"""HTTP endpoints for suggestions."""

from fastapi import APIRouter

from app.features.record.suggestions.service import (
    Decision,
    NewSuggestion,
    SuggestionView,
    add_suggestion,
    decide_suggestion,
    suggestions_of,
)
from app.platform.dependencies import Context, Reading, SignedIn, Writing

router = APIRouter(tags=["suggestions"])


@router.get("/studies/{key}/suggestions")
def get_suggestions(key: str, db: Reading, _: SignedIn) -> list[SuggestionView]:
    """Return all suggestions for a study, those for the newest version first."""
    return suggestions_of(db, key)


@router.post("/studies/{key}/suggestions", status_code=201)
def post_suggestion(
    key: str, wish: NewSuggestion, db: Writing, context: Context, caller: SignedIn
) -> SuggestionView:
    """Add a suggestion about a version of a study, or about one of its steps."""
    return add_suggestion(db, key, wish, by=caller.actor, now=context.clock.utc_now())


@router.post("/suggestions/{suggestion_id}/decision")
def post_decision(
    suggestion_id: str, decision: Decision, db: Writing, context: Context, caller: SignedIn
) -> SuggestionView:
    """Adopt or decline a suggestion; the decision is final."""
    return decide_suggestion(
        db, suggestion_id, decision, by=caller.actor, now=context.clock.utc_now()
    )

"""HTTP endpoints of the demo lab: load it, see how far it is, remove it."""

from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, StringConstraints

from app.errors import InvalidInput
from app.features.record.demo.demo_study import TITLE
from app.features.record.demo.runner import DemoRunner, DemoView
from app.platform.dependencies import Context, SignedIn

router = APIRouter(tags=["demo"])


class DemoWish(BaseModel):
    """A request to load the demo lab, with the language in which its people answer."""

    model_config = ConfigDict(extra="forbid")

    language: Annotated[str, StringConstraints(min_length=2, max_length=8)]


class DemoRemoved(BaseModel):
    """What was removed: `rows` of the database, all of them of simulated people."""

    rows: int


@router.get("/demo")
def get_demo(context: Context, caller: SignedIn) -> DemoView:
    """Return how many simulated people of the demo lab are through."""
    return context.part(DemoRunner).view(caller)


@router.post("/demo", status_code=202)
def post_demo(wish: DemoWish, context: Context, caller: SignedIn) -> DemoView:
    """Load the demo lab: a study of its own, and twelve simulated people who visit it."""
    if wish.language not in TITLE:
        raise InvalidInput(
            f"the demo lab has no texts in the language {wish.language!r}",
            value=wish.language,
            valid=sorted(TITLE),
            remedy="Choose one of these languages.",
        )
    context.storage.require_storage()
    url = context.network.reach.local_url
    return context.part(DemoRunner).load(caller, wish.language, url)


@router.delete("/demo")
def delete_demo(context: Context, caller: SignedIn) -> DemoRemoved:
    """Remove the demo lab: its study, its sessions and everything that they recorded."""
    return DemoRemoved(rows=context.part(DemoRunner).remove(caller))

"""HTTP endpoints of scenes and sets of walks."""

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.errors import InvalidInput
from app.features.movement.files import BODY, BYTES, FileName, attachment, binary
from app.features.movement.walking.scenes import (
    add_scene,
    remove_scene,
    scene_list,
    scene_text,
    scene_view,
)
from app.features.movement.walking.schemas import (
    Kind,
    NewScene,
    NewWalkSet,
    PopulationView,
    SceneListed,
    SceneView,
    Title,
    TracksOrigin,
    WalkSetView,
)
from app.features.movement.walking.walk_sets import (
    Table,
    add_table,
    add_walk_set,
    remove_walk_set,
    walk_set_by_id,
    walk_set_list,
    walk_set_view,
)
from app.platform.dependencies import Context, Reading, SignedIn, Writing

router = APIRouter(prefix="/walking", tags=["walking"])
StatureText = Annotated[str, Query(min_length=3, max_length=90, pattern=r"^[^=]+=[0-9.]+$")]


@router.get("/scenes")
def get_scenes(db: Reading, _: SignedIn) -> list[SceneListed]:
    """Return the scenes: the lab's own and those that come with the product."""
    return scene_list(db)


@router.post("/scenes", status_code=201)
def post_scene(request: NewScene, db: Writing, context: Context, caller: SignedIn) -> SceneView:
    """Store a scene file; every problem of it is reported with its line."""
    return add_scene(db, context, caller, request)


@router.get("/scenes/{scene_key}")
def get_scene(scene_key: str, db: Reading, _: SignedIn) -> SceneView:
    """Return one scene: floor, obstacles, places and paths, in metres seen from above."""
    return scene_view(db, scene_key)


@router.delete("/scenes/{scene_key}", status_code=204)
def delete_scene(scene_key: str, db: Writing, context: Context, caller: SignedIn) -> None:
    """Delete a scene that the lab uploaded."""
    remove_scene(db, context, caller, scene_key)


@router.get(
    "/scenes/{scene_key}/file",
    response_class=Response,
    responses={200: binary("The scene's file, YAML or JSON.")},
)
def get_scene_file(scene_key: str, db: Reading, _: SignedIn) -> Response:
    """Download the scene's file, for example as a template for another scene."""
    text = scene_text(db, scene_key)
    return Response(text, media_type=BYTES, headers=attachment(f"{scene_key}.yaml"))


@router.get("/populations")
def get_populations(_: SignedIn) -> list[PopulationView]:
    """Return the documented populations of synthetic walkers."""
    # Imported here because it is slow to load and rarely needed.
    from app.science.walking.synthetic import POPULATIONS

    return [PopulationView(name=one.name, about=one.about) for one in POPULATIONS]


@router.get("/walk-sets")
def get_walk_sets(db: Reading, _: SignedIn) -> list[WalkSetView]:
    """Return the sets of walks, newest first."""
    return walk_set_list(db)


@router.post("/walk-sets", status_code=201)
async def post_walk_set(request: NewWalkSet, context: Context, caller: SignedIn) -> WalkSetView:
    """Create a set of walks: synthetic ones, which are marked as such, or from captures."""
    return await add_walk_set(context, caller, request)


@router.post("/walk-sets/tracks", status_code=201, openapi_extra=BODY)
async def post_tracks(
    request: Request,
    context: Context,
    caller: SignedIn,
    name: FileName,
    title: Annotated[Title, Query()],
    kind: Kind = "human",
    rate_hz: Annotated[float | None, Query(gt=0.0, le=10_000.0, allow_inf_nan=False)] = None,
    metres_per_unit: Annotated[float | None, Query(ge=1e-6, le=1000.0, allow_inf_nan=False)] = None,
    stature: Annotated[list[StatureText] | None, Query(max_length=500)] = None,
) -> WalkSetView:
    """Store a table of tracks (id, time, x, y), which is the body of the request.

    A column `scene` says in which scene each row was walked; other columns of numbers, such as
    `load_kg`, are numbers on which a model may depend, if they stay the same during a walk.
    `stature` may be given once for each person, as `A=1.78`, in metres.
    """
    origin = TracksOrigin(
        file_name=name,
        rate_hz=rate_hz,
        metres_per_unit=metres_per_unit,
        statures_m=_statures(stature or []),
        reads_columns=True,
    )
    return await add_table(context, caller, Table(title, kind, origin), request.stream())


@router.get("/walk-sets/{set_id}")
def get_walk_set(set_id: str, db: Reading, _: SignedIn) -> WalkSetView:
    """Return one set of walks: its people, number of walks and durations."""
    return walk_set_view(walk_set_by_id(db, set_id))


@router.delete("/walk-sets/{set_id}", status_code=204)
def delete_walk_set(set_id: str, db: Writing, context: Context, caller: SignedIn) -> None:
    """Delete a set of walks; models that were fitted to it stay."""
    remove_walk_set(db, context, caller, set_id)


def _statures(texts: list[str]) -> dict[str, float]:
    found = {}
    for text in texts:
        name, _, height_text = text.rpartition("=")
        try:
            found[name.strip()] = float(height_text)
        except ValueError:
            found[name.strip()] = 0.0
        if not 0.5 <= found[name.strip()] <= 2.6:
            raise InvalidInput(
                f"{name!r} cannot be {height_text} m tall",
                value=height_text,
                valid="0.5 to 2.6 m",
                remedy="Give statures in metres, such as A=1.78.",
            )
    return found

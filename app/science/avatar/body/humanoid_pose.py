"""Convert bones and a mesh in any rest pose to a humanoid in the T-pose.

1. The **bones** must form a body, or an error names what is missing or misplaced.
2. **Up** is y; where the head lies over the hips along another axis, the model is turned.
3. **Size**: where no person has the stature in metres, other units are tried; where none fits, only
   the proportions are used, as a body is scaled to a person's stature anyway.
4. **T-pose** by `app.science.retargeting.t_pose`: trunk, legs and arms are aligned with their axes;
   feet, head and collar bones stay as they are, and fingers keep their pose relative to the hand.
   Each vertex moves rigidly with the bone that has the most influence on it. The model is then
   turned to face -z.
5. The **soles** are the lowest skin of the feet. The **stature** is computed from the height of the
   head's joint above them, which is .875 of the stature in `app.science.skeleton`: the top of a
   mesh may be hair, a hat or horns.

Vertices of bones that are not body parts belong to the nearest bone above that is one; those of
bones above the hips belong to the hips.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from app.science.avatar.body.humanoid import Humanoid, HumanoidError, HumanoidPart
from app.science.avatar.body.humanoid_checks import check_bones, check_feet, check_standing
from app.science.avatar.body.parts import PART_NAMES
from app.science.retargeting import t_pose
from app.science.rig import Rig, RigError
from app.science.rotations import (
    FloatArray,
    Vector,
    conjugate,
    identity,
    matrices,
    multiply,
    rotate,
    swing_between,
)
from app.science.skeleton import JOINT_NAMES

HEAD_AT, ANKLE_AT = 0.875, 0.039
"""Heights of the joints of head and foot above the soles, as fractions of the stature (see
`skeleton`)."""
_UNITS = ((1.0, "metres"), (0.01, "centimetres"), (0.001, "millimetres"))
_LOWEST_M, _HIGHEST_M, _USUAL_M = 0.5, 2.6, 1.75
_UP = np.array((0.0, 1.0, 0.0))
_SOLES = ("LeftFoot", "LeftToes", "RightFoot", "RightToes")
IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class TPosed:
    """A humanoid in the T-pose, and how its bones were brought there.

    Attributes:
        humanoid: the model in the T-pose.
        moves: (J, 4, 4) of each bone of the rig: the similarity from where the file has the bone
            and what is fixed to it, in the file's world, to where they are in the T-pose; with
            rotation, change of unit and translation.
        arms_turned_deg: how far the upper arm that was farther from the T-pose was turned into it,
            relative to the hips.
    """

    humanoid: Humanoid
    moves: FloatArray
    arms_turned_deg: float


@dataclass(frozen=True, eq=False)
class RiggedMesh:
    """Bones at rest with the skin on them, in the world frame of a file.

    Attributes:
        rig: the J bones, y up according to the file.
        bones: HumanBodyBones name -> index of its bone.
        vertices_m: (V, 3) the skin at rest.
        owners: (V,) the bone with the most influence on each vertex.
    """

    rig: Rig
    bones: Mapping[str, int]
    vertices_m: FloatArray
    owners: IndexArray


def humanoid_of(mesh: RiggedMesh) -> TPosed:
    """Bring a rigged mesh into the T-pose.

    Raises:
        HumanoidError: a required part has no bone, or the bones do not form a human body.
    """
    check_bones(mesh.rig, mesh.bones)
    notes: list[str] = []
    mesh, upwards = _upright(mesh, notes)
    check_standing(mesh.rig, mesh.bones)
    mesh, factor = _in_metres(mesh, notes)
    try:
        turns, joints, vertices = _in_t_pose(mesh)
    except RigError as error:
        raise HumanoidError(f"The bones do not form a human skeleton: {error}") from error
    part_of = _parts_of_bones(mesh)[mesh.owners]
    places = {part: joints[mesh.bones[part]] for part in PART_NAMES if part in mesh.bones}
    floor = _floor(places, vertices, part_of)
    origin = np.array((places["Hips"][0], floor, places["Hips"][2]))
    stature_m = float(places["Head"][1] - floor) / HEAD_AT
    parts = {
        part: HumanoidPart(
            _vector(place - origin), vertices[part_of == PART_NAMES.index(part)] - place
        )
        for part, place in places.items()
    }
    check_feet(parts, stature_m)
    moves = np.tile(np.eye(4), (mesh.rig.joint_count, 1, 1))
    moves[:, :3, :3] = matrices(multiply(turns, upwards)) * factor
    moves[:, :3, 3] = joints - origin - rotate(turns, mesh.rig.rest_world()[0])
    humanoid = Humanoid(stature_m, MappingProxyType(parts), tuple(notes))
    return TPosed(humanoid, moves, _arms_turned_deg(mesh, turns))


def _arms_turned_deg(mesh: RiggedMesh, turns: FloatArray) -> float:
    arms = turns[[mesh.bones["LeftUpperArm"], mesh.bones["RightUpperArm"]]]
    relative = multiply(arms, conjugate(turns[mesh.bones["Hips"]]))
    cosines = np.clip(np.abs(relative[:, 0]), 0.0, 1.0)
    return float(np.degrees(2.0 * np.arccos(cosines)).max())


def _upright(mesh: RiggedMesh, notes: list[str]) -> tuple[RiggedMesh, FloatArray]:
    """Return the mesh with its head up, and the rotation (4,) that turned it."""
    places = mesh.rig.rest_world()[0]
    across = places[mesh.bones["Head"]] - places[mesh.bones["Hips"]]
    axis = int(np.argmax(np.abs(across)))
    if not abs(across[axis]) > 0.0:
        raise HumanoidError("Head and hips are at the same position, so this is not a human body.")
    up = np.zeros(3)
    up[axis] = np.sign(across[axis])
    if axis == 1 and up[1] > 0.0:
        return mesh, identity()
    turn = swing_between(up, _UP)
    rig = mesh.rig
    offsets, rotations = rig.offsets_m.copy(), rig.rest_rotations.copy()
    offsets[0], rotations[0] = rotate(turn, offsets[0]), multiply(turn, rotations[0])
    axis_name = f"{'+' if up[axis] > 0.0 else '-'}{'xyz'[axis]}"
    notes.append(f"The head lies over the hips along {axis_name}, so the model was turned upright.")
    turned = replace(
        mesh,
        rig=replace(rig, offsets_m=offsets, rest_rotations=rotations),
        vertices_m=rotate(turn, mesh.vertices_m),
    )
    return turned, turn


def _in_metres(mesh: RiggedMesh, notes: list[str]) -> tuple[RiggedMesh, float]:
    """Return the mesh in metres, and the metres in a unit of the file."""
    heights = mesh.rig.rest_world()[0][:, 1]
    feet = min(heights[mesh.bones["LeftFoot"]], heights[mesh.bones["RightFoot"]])
    stature = float(heights[mesh.bones["Head"]] - feet) / (HEAD_AT - ANKLE_AT)
    factor = 0.0
    for metres, unit in _UNITS:
        if _LOWEST_M <= stature * metres <= _HIGHEST_M:
            factor = metres
            if metres != 1.0:
                notes.append(
                    f"A stature of {stature:.4g} was taken to be in {unit}, not in metres."
                )
            break
    else:
        factor = _USUAL_M / stature
        notes.append(f"No person has a stature of {stature:.4g} m: only the proportions are used.")
    if factor == 1.0:
        return mesh, factor
    rig = replace(mesh.rig, offsets_m=mesh.rig.offsets_m * factor)
    return replace(mesh, rig=rig, vertices_m=mesh.vertices_m * factor), factor


def _in_t_pose(mesh: RiggedMesh) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return how each bone turned (J, 4), and the T-pose, facing -z.

    It has the joints (J, 3) and the vertices (V, 3).
    """
    rig = mesh.rig
    named = {
        part: rig.names[bone] for part, bone in mesh.bones.items() if part in JOINT_NAMES
    }  # fingers turn with the hand
    posed = t_pose(rig, named)
    rest_places, rest_turns = rig.rest_world()
    turns = multiply(posed.world_rotations, conjugate(rest_turns))
    vertices = np.empty_like(mesh.vertices_m)
    for bone in np.unique(mesh.owners).tolist():
        rows = mesh.owners == bone
        moved = rotate(turns[bone], mesh.vertices_m[rows] - rest_places[bone])
        vertices[rows] = moved + posed.positions_m[bone]
    back = conjugate(posed.facing)
    return multiply(back, turns), rotate(back, posed.positions_m), rotate(back, vertices)


def _parts_of_bones(mesh: RiggedMesh) -> IndexArray:
    """Return the index in `PART_NAMES` of the part that each bone belongs to, (J,)."""
    part_of_bone = {bone: PART_NAMES.index(part) for part, bone in mesh.bones.items()}
    found = np.zeros(mesh.rig.joint_count, dtype=np.int64)  # 0 is the hips
    for bone, parent in enumerate(mesh.rig.parents):
        inherited = int(found[parent]) if parent >= 0 else 0
        found[bone] = part_of_bone.get(bone, inherited)
    return found


def _floor(places: Mapping[str, FloatArray], vertices: FloatArray, part_of: IndexArray) -> float:
    feet = np.isin(part_of, [PART_NAMES.index(part) for part in _SOLES])
    if feet.any():
        return float(vertices[feet, 1].min())
    # Feet without skin: take the floor from the usual height of an ankle.
    ankle = float(min(places["LeftFoot"][1], places["RightFoot"][1]))
    return ankle - (float(places["Head"][1]) - ankle) * ANKLE_AT / (HEAD_AT - ANKLE_AT)


def _vector(place: FloatArray) -> Vector:
    x, y, z = place.tolist()
    return (x, y, z)

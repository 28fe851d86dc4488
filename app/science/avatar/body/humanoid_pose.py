"""From bones and a mesh in any rest pose to a humanoid in the T-pose.

1. The bones are a body's, or there is an error that names what is missing or hangs wrongly.
2. **Up** is y; where the head lies over the hips along another axis, the model is turned.
3. **Size**: bones that no person's are in metres are tried in other units; where none fits, only
   the proportions count, as a body is scaled to a person's stature anyhow.
4. **T-pose** by `app.science.retargeting.t_pose`: trunk, legs and arms along their axes, feet, head
   and collar bones as they are, fingers as they lie in the hand. Each vertex goes rigidly with the
   bone that moves it most. The model then faces -z, whichever way it did.
5. The **soles** are the lowest skin of the feet. The **stature** is told by how high over them the
   joint of the head lies, .875 of the stature in `app.science.skeleton`: the top of a mesh may be
   hair, a hat or horns.

Vertices of bones that are no body part belong to the next one above that is, those above the hips
to the hips.
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
from app.science.rotations import FloatArray, Vector, conjugate, multiply, rotate, swing_between
from app.science.skeleton import JOINT_NAMES

HEAD_AT, ANKLE_AT = 0.875, 0.039
"""Heights of the joints of head and foot over the soles, of the stature (see `skeleton`)."""
_UNITS = ((1.0, "metres"), (0.01, "centimetres"), (0.001, "millimetres"))
_LOWEST_M, _HIGHEST_M, _USUAL_M = 0.5, 2.6, 1.75
_UP = np.array((0.0, 1.0, 0.0))
_SOLES = ("LeftFoot", "LeftToes", "RightFoot", "RightToes")
IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RiggedMesh:
    """Bones at rest with the skin on them, in the world of a file.

    Attributes:
        rig: the J bones, y up by the file's word.
        bones: HumanBodyBones name -> index of its bone.
        vertices_m: (V, 3) the skin at rest.
        owners: (V,) the bone that moves each vertex most.
    """

    rig: Rig
    bones: Mapping[str, int]
    vertices_m: FloatArray
    owners: IndexArray


def humanoid_of(mesh: RiggedMesh) -> Humanoid:
    """Bring a rigged mesh into the T-pose.

    Raises:
        HumanoidError: a required part has no bone, or the bones hang as no human body's do.
    """
    check_bones(mesh.rig, mesh.bones)
    notes: list[str] = []
    mesh = _upright(mesh, notes)
    check_standing(mesh.rig, mesh.bones)
    mesh = _in_metres(mesh, notes)
    try:
        joints, vertices = _in_t_pose(mesh)
    except RigError as error:
        raise HumanoidError(f"The bones are no human body's: {error}") from error
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
    return Humanoid(stature_m, MappingProxyType(parts), tuple(notes))


def _upright(mesh: RiggedMesh, notes: list[str]) -> RiggedMesh:
    places = mesh.rig.rest_world()[0]
    across = places[mesh.bones["Head"]] - places[mesh.bones["Hips"]]
    axis = int(np.argmax(np.abs(across)))
    if not abs(across[axis]) > 0.0:
        raise HumanoidError("The head lies where the hips are, so this is no human body.")
    up = np.zeros(3)
    up[axis] = np.sign(across[axis])
    if axis == 1 and up[1] > 0.0:
        return mesh
    turn = swing_between(up, _UP)
    rig = mesh.rig
    offsets, rotations = rig.offsets_m.copy(), rig.rest_rotations.copy()
    offsets[0], rotations[0] = rotate(turn, offsets[0]), multiply(turn, rotations[0])
    told = f"{'+' if up[axis] > 0.0 else '-'}{'xyz'[axis]}"
    notes.append(f"The head lies over the hips along {told}, so the model was turned upright.")
    return replace(
        mesh,
        rig=replace(rig, offsets_m=offsets, rest_rotations=rotations),
        vertices_m=rotate(turn, mesh.vertices_m),
    )


def _in_metres(mesh: RiggedMesh, notes: list[str]) -> RiggedMesh:
    heights = mesh.rig.rest_world()[0][:, 1]
    feet = min(heights[mesh.bones["LeftFoot"]], heights[mesh.bones["RightFoot"]])
    told = float(heights[mesh.bones["Head"]] - feet) / (HEAD_AT - ANKLE_AT)
    factor = 0.0
    for metres, unit in _UNITS:
        if _LOWEST_M <= told * metres <= _HIGHEST_M:
            factor = metres
            if metres != 1.0:
                notes.append(f"A stature of {told:.4g} m was taken for {unit}.")
            break
    else:
        factor = _USUAL_M / told
        notes.append(f"A stature of {told:.4g} m is no person's: only the proportions count.")
    if factor == 1.0:
        return mesh
    rig = replace(mesh.rig, offsets_m=mesh.rig.offsets_m * factor)
    return replace(mesh, rig=rig, vertices_m=mesh.vertices_m * factor)


def _in_t_pose(mesh: RiggedMesh) -> tuple[FloatArray, FloatArray]:
    """Joints (J, 3) and vertices (V, 3), facing -z."""
    rig = mesh.rig
    named = {
        part: rig.names[bone] for part, bone in mesh.bones.items() if part in JOINT_NAMES
    }  # fingers turn with the hand
    posed = t_pose(rig, named)
    rest_places, rest_turns = rig.rest_world()
    vertices = np.empty_like(mesh.vertices_m)
    for bone in np.unique(mesh.owners).tolist():
        rows = mesh.owners == bone
        turn = multiply(posed.world_rotations[bone], conjugate(rest_turns[bone]))
        moved = rotate(turn, mesh.vertices_m[rows] - rest_places[bone])
        vertices[rows] = moved + posed.positions_m[bone]
    back = conjugate(posed.facing)
    return rotate(back, posed.positions_m), rotate(back, vertices)


def _parts_of_bones(mesh: RiggedMesh) -> IndexArray:
    """(J,) index in `PART_NAMES` of the part each bone belongs to."""
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
    # Without a skin on the feet, as high as an ankle is.
    ankle = float(min(places["LeftFoot"][1], places["RightFoot"][1]))
    return ankle - (float(places["Head"][1]) - ankle) * ANKLE_AT / (HEAD_AT - ANKLE_AT)


def _vector(place: FloatArray) -> Vector:
    x, y, z = place.tolist()
    return (x, y, z)

"""The avatar's body: parts, axes, proportions, masses and shapes.

`PART_NAMES`, `AXES` and related tables define the 52 parts and the order of their axes.
`build_body` makes a `Body` from a stature or from a model's lengths, `body_masses` distributes its
mass among the parts, and `figure_of` measures a `Humanoid`, a rigged model. All positions are in
metres in the T-pose, y up; nothing here depends on a simulator.
"""

from app.science.avatar.body.binding import Binding, bind
from app.science.avatar.body.body import REQUIRED_PARTS, Body, BodyPart, build_body
from app.science.avatar.body.deleva import Population, mass_fractions, segments_of
from app.science.avatar.body.figure import Figure, figure_of
from app.science.avatar.body.fingers import finger_bones
from app.science.avatar.body.hulls import Piece
from app.science.avatar.body.humanoid import Humanoid, HumanoidError
from app.science.avatar.body.humanoid_pose import RiggedMesh, TPosed, humanoid_of
from app.science.avatar.body.inertial import Inertial, combined
from app.science.avatar.body.layers import (
    COLLIDING,
    LAYER_OF,
    LAYERS,
    NO_COLLISION,
    SCENE,
    SCENE_BIT,
    SWITCHABLE_LAYERS,
    CollisionBits,
    collision_bits,
    excluded_pairs,
    layer_bit,
)
from app.science.avatar.body.masses import BodyMasses, body_masses
from app.science.avatar.body.parts import (
    AXES,
    AXES_OF,
    AXIS_NAMES,
    FINGER_PARTS,
    FINGERS,
    PARENT_OF,
    PART_NAMES,
    SEGMENTS,
    SIDES,
    Axis,
    Letter,
    mirrored_name,
)
from app.science.avatar.body.proportions import SEGMENT_NAMES, BodyError, Proportions, proportions
from app.science.avatar.body.shapes import Capsule, Shape
from app.science.avatar.body.skinning import NodeTree, SkinPiece, posed_nodes, posed_vertices

__all__ = [
    "AXES",
    "AXES_OF",
    "AXIS_NAMES",
    "COLLIDING",
    "FINGERS",
    "FINGER_PARTS",
    "LAYERS",
    "LAYER_OF",
    "NO_COLLISION",
    "PARENT_OF",
    "PART_NAMES",
    "REQUIRED_PARTS",
    "SCENE",
    "SCENE_BIT",
    "SEGMENTS",
    "SEGMENT_NAMES",
    "SIDES",
    "SWITCHABLE_LAYERS",
    "Axis",
    "Binding",
    "Body",
    "BodyError",
    "BodyMasses",
    "BodyPart",
    "Capsule",
    "CollisionBits",
    "Figure",
    "Humanoid",
    "HumanoidError",
    "Inertial",
    "Letter",
    "NodeTree",
    "Piece",
    "Population",
    "Proportions",
    "RiggedMesh",
    "Shape",
    "SkinPiece",
    "TPosed",
    "bind",
    "body_masses",
    "build_body",
    "collision_bits",
    "combined",
    "excluded_pairs",
    "figure_of",
    "finger_bones",
    "humanoid_of",
    "layer_bit",
    "mass_fractions",
    "mirrored_name",
    "posed_nodes",
    "posed_vertices",
    "proportions",
    "segments_of",
]

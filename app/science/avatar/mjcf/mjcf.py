"""Write the avatar as a MuJoCo model, byte for byte the same on every machine.

Each part is a rigid body in its parent's frame, and each of its axes a hinge in the order of
`parts.AXES_OF`, so a part's rotation is the product of its axes' rotations. A hinge has a motor of
the same name: a PD controller with a target angle and a target speed,

    torque = kp (angle* - angle) + kd (speed* - speed),   clamped to the torque limit,

whose target angle is clamped to the hinge's limits. `data.ctrl` holds the two targets of each motor
next to each other: angle, speed, angle, speed, in the order of `driven_axes`. A locked axis has
neither hinge nor motor; the part is turned by the locked angle.

A part's convex piece, where it has one, is added as a mesh next to its simple shapes; shapes that
the part does not collide with have empty masks (`Colliders`).

`model_options` describes how the hips follow the participant.

The order of elements and attributes and the formatting of numbers are fixed.
"""

from collections.abc import Iterable, Mapping
from math import ceil
from xml.sax.saxutils import quoteattr

from app.science.avatar.body import (
    AXES_OF,
    NO_COLLISION,
    SCENE,
    SCENE_BIT,
    Axis,
    Body,
    BodyError,
    BodyMasses,
    BodyPart,
    Capsule,
    CollisionBits,
    Inertial,
    Piece,
    Shape,
    collision_bits,
    excluded_pairs,
)
from app.science.avatar.configuration import (
    DEFAULT_OPTIONS,
    FRICTION,
    HIPS_TARGET,
    LIMIT_SOLREF,
    SIMPLE,
    WALL_SOLIMP,
    WALL_SOLREF,
    WELD_SOLIMP,
    WELD_SOLREF,
    AxisSettings,
    Colliders,
    ModelOptions,
)
from app.science.avatar.mjcf.hinges import hinges_of, with_locks
from app.science.avatar.mjcf.scene import FLOOR, FLOOR_ONLY, Scene
from app.science.rotations import IDENTITY, Vector

Value = str | float | Iterable[float]
_INDENT = "  "


def number(value: float) -> str:
    """Format a number with twelve digits.

    That is more than any measurement has, and few enough to be the same on every machine.
    """
    text = f"{value:.12g}"
    return "0" if text == "-0" else text


class Element:
    """An XML element whose attributes and children stay in the order in which they were added."""

    def __init__(self, tag: str, /, **attributes: Value | None) -> None:
        self._tag = tag
        self._attributes = {
            name.rstrip("_"): _text(value)
            for name, value in attributes.items()
            if value is not None
        }
        self._children: list[Element] = []

    def add(self, tag: str, /, **attributes: Value | None) -> "Element":
        """Append a child and return it."""
        child = Element(tag, **attributes)
        self._children.append(child)
        return child

    def lines(self, depth: int = 0) -> Iterable[str]:
        """Yield the element as indented lines of text."""
        pad = _INDENT * depth
        attributes = "".join(
            f" {name}={quoteattr(text)}" for name, text in self._attributes.items()
        )
        if not self._children:
            yield f"{pad}<{self._tag}{attributes}/>"
            return
        yield f"{pad}<{self._tag}{attributes}>"
        for child in self._children:
            yield from child.lines(depth + 1)
        yield f"{pad}</{self._tag}>"

    def text(self) -> str:
        """Return the element and its children as one text that ends with a newline."""
        return "\n".join(self.lines()) + "\n"


def _text(value: Value) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return number(value)
    return " ".join(number(part) for part in value)


PIECE = "mesh"
"""Name of the geom of a convex piece, after its part and a slash."""
NO_TORQUE_NM = 1e-9
"""Force range of a motor without torque: MuJoCo reads a range of zero as unlimited."""


def driven_axes(body: Body, settings: Mapping[str, AxisSettings]) -> tuple[Axis, ...]:
    """Return the axes that have a hinge and a motor, in the order of the model's hinges.

    Raises:
        BodyError: an axis of a present part has no settings.
    """
    driven: list[Axis] = []
    for part in body.parts:
        for axis in AXES_OF[part]:
            if axis.name not in settings:
                raise BodyError(
                    f"The axis {axis.name} has no settings: give gains and limits for every axis"
                    " of every part the body has."
                )
            if not settings[axis.name].locked:
                driven.append(axis)
    return tuple(driven)


def build_mjcf(
    body: Body,
    masses: BodyMasses,
    settings: Mapping[str, AxisSettings],
    *,
    scene: Scene = FLOOR_ONLY,
    options: ModelOptions = DEFAULT_OPTIONS,
    colliders: Colliders = SIMPLE,
) -> str:
    """Return the MJCF text of one avatar in one scene.

    Bodies are named after parts, hinges and motors after axes, shapes `LeftHand/0`, convex pieces
    `LeftHand/mesh`, blocks of the scene by their own names, the floor `floor`.

    Raises:
        BodyError: an axis of a present part has no settings.
    """
    return _Model(body, masses, settings, scene, options, colliders).text()


class _Model:
    def __init__(
        self,
        body: Body,
        masses: BodyMasses,
        settings: Mapping[str, AxisSettings],
        scene: Scene,
        options: ModelOptions,
        colliders: Colliders,
    ) -> None:
        self._body, self._masses, self._settings = body, masses, settings
        self._scene, self._options, self._colliders = scene, options, colliders
        self._pieces: dict[str, Piece] = {
            name: part.piece
            for name, part in body.parts.items()
            if colliders.both and part.piece is not None
        }
        self._driven = driven_axes(body, settings)
        self._hinges = hinges_of(body, masses)

    def text(self) -> str:
        root = Element("mujoco", model="avatar")
        root.add("compiler", angle="radian", autolimits="true")
        gravity = (0.0, -9.81 if self._options.gravity else 0.0, 0.0)
        option = root.add(
            "option", timestep=self._options.step_s, gravity=gravity, integrator="implicitfast"
        )
        if self._pieces or "none" in self._colliders.kinds.values():
            # When the model is loaded, the tree of the midphase leaves out geoms that do not
            # collide, so those whose collisions are switched on later would never be found.
            option.add("flag", midphase="disable")
        if self._pieces:
            assets = root.add("asset")
            for name, piece in self._pieces.items():
                corners = (value for corner in piece.corners_m for value in corner)
                assets.add("mesh", name=name, vertex=corners, inertia="convex")
        world = root.add("worldbody")
        self._add_scene(world)
        self._add_body(world)
        self._add_loose(world)
        contact = root.add("contact")
        parents = {name: part.parent for name, part in self._body.parts.items()}
        for first, second in excluded_pairs(parents, self._options.colliding):
            contact.add("exclude", body1=first, body2=second)
        if self._options.hips == "welded":
            root.add("equality").add(
                "weld", body1=HIPS_TARGET, body2="Hips", relpose=(0, 0, 0, 1, 0, 0, 0),
                solref=WELD_SOLREF, solimp=WELD_SOLIMP,
            )  # fmt: skip
        actuator = root.add("actuator")
        for axis in self._driven:
            self._add_motor(actuator, axis)
        return root.text()

    def _add_scene(self, world: Element) -> None:
        solver = {"solref": WALL_SOLREF, "solimp": WALL_SOLIMP, "friction": FRICTION}
        if self._scene.floor:
            world.add(
                "geom", name=FLOOR, type_="plane", size=(0, 0, 1), zaxis=(0, 1, 0),
                **_masks(SCENE), priority=1, **solver,
            )  # fmt: skip
        for box in self._scene.boxes:
            world.add(
                "geom", name=box.name, type_="box", pos=box.center_m, size=box.half_size_m,
                **_masks(SCENE if box.solid else NO_COLLISION), priority=1, **solver,
            )  # fmt: skip

    def _add_loose(self, world: Element) -> None:
        """Add the boxes that move freely: after the avatar, whose hinges then stay the first."""
        for box in self._scene.loose:
            body = world.add("body", name=box.name, pos=box.center_m, gravcomp=1)
            body.add("freejoint", name=box.name)
            body.add(
                "geom", name=box.name, type_="box", size=box.half_size_m, mass=box.mass_kg,
                contype=SCENE_BIT, conaffinity=SCENE_BIT, priority=1,
                solref=WALL_SOLREF, solimp=WALL_SOLIMP, friction=FRICTION,
            )  # fmt: skip

    def _add_body(self, world: Element) -> None:
        place = self._body.parts["Hips"].joint_m
        welded = self._options.hips == "welded"
        if welded:
            world.add("body", name=HIPS_TARGET, mocap="true", pos=place)
        elements: dict[str, Element] = {}
        for name, part in self._body.parts.items():
            above = world if part.parent is None else elements[part.parent]
            carried = part.parent is None and not welded
            axes = AXES_OF[name]
            turn, hinges = with_locks(axes, [self._locked_rad(axis) for axis in axes])
            elements[name] = element = above.add(
                "body", name=name, mocap="true" if carried else None, pos=part.joint_m,
                quat=None if turn == IDENTITY else turn,
                gravcomp=1.0 if name in self._options.carried_parts else None,
            )  # fmt: skip
            if part.parent is None and welded:
                element.add("freejoint", name="Hips")
            self._fill(element, part, hinges)

    def _fill(self, element: Element, part: BodyPart, hinges: list[tuple[Axis, Vector]]) -> None:
        element.add("inertial", **_inertial(self._masses.parts[part.name]))
        for axis, direction in hinges:
            settings, hinge = self._settings[axis.name], self._hinges[axis.name]
            element.add(
                "joint", name=axis.name, axis=direction,
                range_=(settings.low_rad, settings.high_rad), solreflimit=LIMIT_SOLREF,
                damping=hinge.damping_nm_s, armature=hinge.armature_kg_m2,
            )  # fmt: skip
        self._add_shapes(element, part)

    def _add_shapes(self, element: Element, part: BodyPart) -> None:
        bits = collision_bits(
            part.name,
            self_collision=self._options.self_collision,
            colliding=self._options.colliding,
        )
        kind = self._colliders.of(part.name)
        if kind == "mesh" and part.name not in self._pieces:
            kind = "simple"
        simple, mesh = (_masks(bits if kind == one else NO_COLLISION) for one in ("simple", "mesh"))
        for index, shape in enumerate(part.shapes):
            element.add("geom", name=f"{part.name}/{index}", **_shape(shape), **simple)
        if part.name in self._pieces:
            element.add("geom", name=f"{part.name}/{PIECE}", type_="mesh", mesh=part.name, **mesh)

    def _locked_rad(self, axis: Axis) -> float | None:
        settings = self._settings[axis.name]
        return settings.low_rad if settings.locked else None

    def _add_motor(self, actuator: Element, axis: Axis) -> None:
        settings = self._settings[axis.name]
        torque = max(settings.max_torque_nm, NO_TORQUE_NM)
        own_delay_s = self._options.delays_s.get(axis.part, 0.0)
        longest_s, step_s = self._options.longest_delay_s, self._options.step_s
        own_samples = ceil(own_delay_s / step_s - 1e-9)
        samples = round(longest_s / step_s) + own_samples + 1
        has_buffer = longest_s > 0.0 or own_delay_s > 0.0
        actuator.add(
            "pid", name=axis.name, joint=axis.name, input="pos vel", kp=settings.kp, kv=settings.kd,
            posrange=(settings.low_rad, settings.high_rad), forcerange=(-torque, torque),
            delay=own_delay_s if has_buffer else None, nsample=samples if has_buffer else None,
        )  # fmt: skip


def _masks(bits: CollisionBits) -> dict[str, float]:
    return {"contype": bits.contype, "conaffinity": bits.conaffinity}


def _inertial(part: Inertial) -> dict[str, float | tuple[float, ...]]:
    xx, yy, zz, xy, xz, yz = part.inertia_kg_m2
    # Off-diagonal terms are rounding errors, unless the limb is not parallel to the axes.
    askew = max(abs(xy), abs(xz), abs(yz)) > 1e-9 * max(xx, yy, zz)
    kind = "fullinertia" if askew else "diaginertia"
    values = part.inertia_kg_m2 if askew else (xx, yy, zz)
    return {"pos": part.center_m, "mass": part.mass_kg, kind: values}


def _shape(shape: Shape) -> dict[str, str | float | Vector | tuple[float, ...]]:
    if not isinstance(shape, Capsule):
        return {"type_": "box", "pos": shape.center_m, "size": shape.half_size_m}
    if shape.start_m == shape.end_m:
        return {"type_": "sphere", "pos": shape.start_m, "size": shape.radius_m}
    ends = (*shape.start_m, *shape.end_m)
    return {"type_": "capsule", "fromto": ends, "size": shape.radius_m}

"""Operations on the body: masses, colliders, layers, delays, casts, and other configurations."""

from dataclasses import replace
from math import radians
from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from app.protocol.avatar import (
    AvatarFile,
    HumanoidHash,
    Percent,
    configuration_of,
)
from app.protocol.avatar_changes import AxisName, BodyGroup, Layer
from app.protocol.avatar_editing.operation import (
    Aspects,
    AvatarOperation,
    Groups,
    Part,
    Versions,
    present_parts,
    problem,
    require_values,
)
from app.science.avatar.body import AXIS_NAMES, PART_NAMES, Population
from app.science.avatar.configuration import (
    MAX_OWN_DELAY_S,
    ColliderKind,
    Compliance,
    Configuration,
    Hips,
    LimbTargets,
    TargetSpace,
    compliant_groups,
    lock,
    reset,
    unlock,
    with_colliders,
    with_compliance,
    with_delays,
    with_layers,
    without_parts,
)


class SetMasses(AvatarOperation):
    """The mass of the body, and how it is distributed.

    `population` supplies the relative masses. `percent`: body part -> its share of the mass; null
    gives a part the population's again. `distribution`: `population` takes all given shares back,
    `equal` gives all 52 parts the same mass.
    """

    operation: Literal["set_masses"]
    total_mass_kg: Annotated[float | None, Field(ge=1, le=500, description="kg")] = None
    population: Population | None = None
    distribution: Literal["population", "equal"] | None = None
    percent: Annotated[
        dict[Part, Percent | None], Field(default_factory=dict, max_length=len(PART_NAMES))
    ]

    def applied(self, configuration: Configuration) -> Configuration:
        """Set what is given: first the distribution, then the shares of single parts."""
        require_values(self, {"operation"})
        shares = dict(configuration.relative_masses)
        if self.distribution is not None:
            share = 1.0 / len(PART_NAMES)
            shares = dict.fromkeys(PART_NAMES, share) if self.distribution == "equal" else {}
        shares |= {part: one / 1e2 for part, one in self.percent.items() if one is not None}
        for part, given in self.percent.items():
            if given is None:
                shares.pop(part, None)
        return replace(
            configuration,
            total_mass_kg=self.total_mass_kg or configuration.total_mass_kg,
            population=self.population or configuration.population,
            relative_masses=shares,
        )


class SetBody(AvatarOperation):
    """Settings of the whole body: gravity, collisions, how the hips move, kind of targets."""

    operation: Literal["set_body"]
    gravity: bool | None = None
    self_collision: bool | None = None
    hips: Hips | None = None
    target_space: TargetSpace | None = None

    def applied(self, configuration: Configuration) -> Configuration:
        """Set what is given."""
        require_values(self, {"operation"})
        return replace(configuration, **self.model_dump(exclude={"operation"}, exclude_none=True))


class SetModel(AvatarOperation):
    """The humanoid model whose body is worn, by its hash; null for a body of person's measures."""

    operation: Literal["set_model"]
    humanoid: HumanoidHash | None

    def applied(self, configuration: Configuration) -> Configuration:
        """Set the model."""
        return replace(configuration, humanoid=self.humanoid)


class SetColliders(AvatarOperation):
    """The kind of collider of groups or parts; `all` sets that of the whole body."""

    operation: Literal["set_colliders"]
    targets: Groups
    kind: ColliderKind

    def applied(self, configuration: Configuration) -> Configuration:
        """Set the kind for every part of the targets."""
        return with_colliders(configuration, self.targets, self.kind)


class SetLayers(AvatarOperation):
    """Whether the parts of two collision layers collide with each other."""

    operation: Literal["set_layers"]
    layers: Annotated[tuple[Layer, Layer], Field(strict=False)]
    collide: bool

    def applied(self, configuration: Configuration) -> Configuration:
        """Set one cell of the matrix of layers."""
        return with_layers(configuration, self.layers, collide=self.collide)


class SetDelays(AvatarOperation):
    """The time by which body parts lag, in addition to the latency of the condition."""

    operation: Literal["set_delays"]
    targets: Groups
    delay_ms: Annotated[float, Field(ge=0, le=1e3 * MAX_OWN_DELAY_S, description="ms")]

    def applied(self, configuration: Configuration) -> Configuration:
        """Set the delay of every driven part of the targets."""
        present_parts(configuration, self.targets)
        return with_delays(configuration, self.targets, self.delay_ms / 1e3)


class SetCompliance(AvatarOperation):
    """How groups give way when they are pushed; what is null stays as it is.

    `all` is every group that can be compliant, and `trunk_head` two of them. `limb_targets` are of
    arms and legs: `world` can only be given to these, `joint` to any group.
    """

    operation: Literal["set_compliance"]
    targets: Groups
    stiffness_percent: Annotated[float | None, Field(ge=1, le=100, description="%")] = None
    limb_targets: LimbTargets | None = None

    def applied(self, configuration: Configuration) -> Configuration:
        """Set stiffness, targets or both; 100 % and joint targets make a group stiff again."""
        require_values(self, {"operation", "targets"})
        for group in compliant_groups(self.targets):
            own = configuration.compliance.get(group, Compliance())
            if self.stiffness_percent is not None:
                own = replace(own, stiffness=self.stiffness_percent / 1e2)
            if self.limb_targets is not None:
                own = replace(own, targets=self.limb_targets)
            configuration = with_compliance(configuration, [group], own)
        return configuration


class Lock(AvatarOperation):
    """Put a body group or part into a cast, at the angles of `held_deg`, or else the T-pose's."""

    operation: Literal["lock"]
    group: BodyGroup
    held_deg: Annotated[
        dict[AxisName, Annotated[float, Field(ge=-180, le=180)]],
        Field(default_factory=dict, max_length=len(AXIS_NAMES)),
    ]

    def applied(self, configuration: Configuration) -> Configuration:
        """Lock the group; locking a locked one replaces its angles."""
        held = {name: radians(angle) for name, angle in self.held_deg.items()}
        return lock(configuration, self.group, held)


class Unlock(AvatarOperation):
    """Take the cast of a body group or part off; `all` takes every cast off."""

    operation: Literal["unlock"]
    group: BodyGroup

    def applied(self, configuration: Configuration) -> Configuration:
        """Unlock the group; casts that overlap it stay, unless `all` is named."""
        if self.group == "all":
            return replace(configuration, locked_groups=(), held_rad={})
        return unlock(configuration, self.group)


class RemoveParts(AvatarOperation):
    """Leave out body parts that a model lacks, such as a finger."""

    operation: Literal["remove_parts"]
    targets: Groups

    def applied(self, configuration: Configuration) -> Configuration:
        """Leave out every part of the targets with its axes."""
        return without_parts(configuration, frozenset(present_parts(configuration, self.targets)))


class Load(AvatarOperation):
    """Load a saved version of an avatar, by default its newest one, or a configuration given here.

    With `targets` only those groups take what is asked for from it, as when an arm is reset to the
    shipped settings (`standard`); without them the whole configuration is replaced.
    """

    operation: Literal["load"]
    key: Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,79}$")] | None = None
    version: Annotated[int | None, Field(ge=1, le=1_000_000)] = None
    configuration: AvatarFile | None = None
    targets: Groups | None = None
    what: Aspects = ("gains", "limits")

    def source(self, versions: Versions) -> Configuration:
        """Return the configuration that is loaded; raise AvatarSettingsError."""
        if (self.key is None) == (self.configuration is None):
            raise problem(
                "key",
                "Neither an avatar nor a configuration is given."
                if self.key is None
                else "Both an avatar and a configuration are given.",
                value=self.key,
                valid=["key", "configuration"],
                remedy="Give the key of a saved avatar, or a configuration.",
            )
        if self.key is not None:
            return versions(self.key, self.version)
        assert self.configuration is not None  # noqa: S101 - one of the two is given
        return configuration_of(self.configuration)

    def applied(self, configuration: Configuration) -> Configuration:
        """Return the configuration given here, or take what is asked for from it."""
        if self.configuration is None:
            raise problem("key", "The saved version is not known here.", value=self.key)
        return self.taken(configuration, configuration_of(self.configuration))

    def taken(self, configuration: Configuration, source: Configuration) -> Configuration:
        """Return the source, or the configuration with what is asked for from the source."""
        if self.targets is None:
            return source
        return reset(configuration, source, group=self.targets, aspects=self.what)

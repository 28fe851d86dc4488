"""A study as a value: everything that determines what happens to a participant."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, StringConstraints

from app.plain_titles import not_plain
from app.protocol.common import Key, Provenance, Strict, Text, canonical_json, refusal, sha256_of
from app.protocol.conditions import Condition, Conditions, Orders
from app.protocol.preregistration import Preregistration
from app.protocol.procedure import FormStep, Procedure
from app.protocol.road_scenes import StudyRoad
from app.protocol.safety import Safety
from app.protocol.simulation import Simulation
from app.protocol.tasks import Appearance, Tasks
from app.protocol.validity import ValidWhen
from app.science.skeleton import JOINT_NAMES

SCREEN_TEXTS = ("waiting", "freeze", "walk_back")
"""Texts that every study needs, because devices show them outside of any step."""


def _languages(languages: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(languages)) < len(languages):
        raise refusal("A language is named twice.", value=list(languages), remedy="Name it once.")
    return languages


def _plain(title: Mapping[str, str]) -> Mapping[str, str]:
    for language, text in title.items():
        if (problem := not_plain(text)) is not None:
            raise refusal(
                f"The title ({language}) is not plain text. {problem}",
                value=text,
                remedy="Remove the character, or type the title again.",
            )
    return title


def _joints(parts: tuple[str, ...]) -> tuple[str, ...]:
    unknown = [part for part in parts if part not in JOINT_NAMES]
    if unknown:
        raise refusal(
            f"{unknown[0]!r} is not a body part that can be shown without delay.",
            value=unknown[0],
            valid=list(JOINT_NAMES),
            remedy="Use the names of Unity's HumanBodyBones, as in Hips.",
        )
    return parts


Language = Annotated[
    str,
    StringConstraints(pattern=r"^[a-z]{2,3}(-[A-Z]{2})?$"),
    Field(description="a language code such as en or de"),
]


class Blinding(Strict):
    """The blinding of a study: who must not know the condition. Participants never learn it.

    `operator`: conditions and orders are then hidden from operators permanently, and from everybody
    else until the session that holds the slot is completed.
    """

    operator: bool


class LatencySettings(Strict):
    """The settings of how the added latency acts on the remote avatar.

    `undelayed_parts`: parts whose target is never delayed; in the thesis the hips, which helps
    balance. Nothing is ever buffered at 0 ms. `bypass_at_zero` specified that in older files: it is
    still accepted and kept in their content, but has no effect.
    """

    undelayed_parts: Annotated[tuple[str, ...], AfterValidator(_joints)] = ("Hips",)
    bypass_at_zero: Annotated[
        bool | None,
        # Marked for the editor, which does not show it.
        Field(json_schema_extra={"deprecated": True}, exclude_if=lambda value: value is None),
    ] = None


class AvatarChoice(Strict):
    """The version of an avatar's configuration that the sessions use."""

    key: Annotated[
        str,
        StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,79}$"),
        Field(description="the key of an avatar"),
    ]
    version: Annotated[int, Field(ge=1, le=1_000_000, description="number of its version")]


class StudyProtocol(Strict):
    """A study: conditions, orders, procedure, task places, appearance and texts.

    `avatar`: the remote avatar repeats the participant's movement (`delayed_copy`), or follows it
    by forces and collides (`physics`), as configured by `avatar_configuration`. `road`: what
    participants cross, if the procedure has that.
    """

    key: Annotated[
        str,
        StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,79}$"),
        Field(description="lower-case letters, digits, - and _, at most 80"),
    ]
    title: Annotated[Text, AfterValidator(_plain)]
    description: Text
    provenance: Provenance
    languages: Annotated[tuple[Language, ...], Field(min_length=1), AfterValidator(_languages)]
    avatar: Literal["delayed_copy", "physics"]
    conditions: Conditions
    orders: Orders
    procedure: Procedure
    on_disconnect: Literal["pause", "continue"]
    blinding: Blinding
    latency: LatencySettings
    tasks: Tasks
    appearance: Appearance
    texts: dict[Key, Text]
    # Left out of the content if not set, so that the hashes of other studies stay the same.
    safety: Annotated[Safety | None, Field(exclude_if=lambda value: value is None)] = None
    avatar_configuration: Annotated[
        AvatarChoice | None, Field(exclude_if=lambda value: value is None)
    ] = None
    valid_when: Annotated[ValidWhen | None, Field(exclude_if=lambda value: value is None)] = None
    preregistration: Annotated[
        Preregistration | None, Field(exclude_if=lambda value: value is None)
    ] = None
    road: Annotated[StudyRoad | None, Field(exclude_if=lambda value: value is None)] = None
    simulation: Annotated[Simulation | None, Field(exclude_if=lambda value: value is None)] = None

    def condition(self, key: str) -> Condition:
        """Return the condition with that key; raise StopIteration if there is none."""
        return next(condition for condition in self.conditions if condition.key == key)

    @property
    def instrument_keys(self) -> tuple[str, ...]:
        """The keys of all instruments of the study, in order of first use."""
        steps = (*self.procedure.before, *self.procedure.after)
        forms = [step.instrument for step in steps if isinstance(step, FormStep)]
        block = self.procedure.block
        crossing = [] if block.crossing is None else [block.crossing.questionnaire]
        after_tasks = [*crossing, *(phase.questionnaire for phase in block.phases)]
        after_block = [step.instrument for step in block.after]
        return tuple(dict.fromkeys([*forms, *after_tasks, *after_block]))

    @property
    def bodies(self) -> tuple[str, ...]:
        """The bodies that conditions name, in order of first use."""
        return tuple(dict.fromkeys(one.body for one in self.conditions if one.body is not None))

    @property
    def has_latencies_apart(self) -> bool:
        """Whether each condition has a latency of its own, by which it can be told apart."""
        return len({one.latency_ms for one in self.conditions}) == len(self.conditions)

    @property
    def levels(self) -> dict[str, str]:
        """What orders call each condition: its latency in ms, or its key if some share latencies.

        The keys of the mapping are those of the conditions.
        """
        apart = self.has_latencies_apart
        return {one.key: f"{one.latency_ms:g}" if apart else one.key for one in self.conditions}

    def bodies_of(self, order: Sequence[str]) -> tuple[str | None, ...] | None:
        """The bodies worn in an order of conditions (by key), None for the configuration's body.

        None instead of all of them if latencies alone tell the conditions apart.
        """
        if self.has_latencies_apart:
            return None
        return tuple(self.condition(key).body for key in order)

    @property
    def design_hash(self) -> str:
        """The SHA-256 of what determines balance: conditions (without their labels) and orders.

        Versions of a study with the same design hash can share one ledger.
        """
        conditions = [one.model_dump(mode="json", exclude={"label"}) for one in self.conditions]
        design = {"conditions": conditions, "orders": self.orders.model_dump(mode="json")}
        return sha256_of(canonical_json(design))

"""What a simulation of a study assumes of people: every number with its unit and its source.

Nobody has measured these numbers in the study that is planned, so each one says where it comes
from: a publication, or "assumed". What a simulation finds is true of these assumptions only.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, refusal
from app.protocol.preregistration import Preregistration
from app.protocol.source import Path, Plain
from app.protocol.study import StudyProtocol
from app.science.instruments import DefinitionProblem, Instrument, Item, names_in

Limb = Literal["hand", "foot"]
Source = Annotated[
    str,
    StringConstraints(min_length=1, max_length=500),
    Field(description='where the number comes from: a publication, or "assumed"'),
]
UNITS: Mapping[str, str] = {"contact_time": "s", "completions": "tasks"}
"""The unit of each measure that is no score."""


class Logits(Strict):
    """A number on the trait's scale."""

    value: Annotated[float, Field(ge=-20, le=20, description="logits, -20 to 20")]
    unit: Literal["logits"]
    source: Source


class Spread(Strict):
    """A standard deviation on the trait's scale."""

    value: Annotated[float, Field(ge=0, le=20, description="logits, 0 to 20")]
    unit: Literal["logits"]
    source: Source


class Share(Strict):
    """A probability or a share."""

    value: Annotated[float, Field(ge=0, le=1, description="0 to 1")]
    unit: Literal["share"]
    source: Source


class SignedShare(Strict):
    """A share that may point the other way."""

    value: Annotated[float, Field(ge=-1, le=1, description="-1 to 1")]
    unit: Literal["share"]
    source: Source


class Factor(Strict):
    """A factor, such as the discrimination of an item."""

    value: Annotated[float, Field(gt=0, le=10, description="above 0, at most 10")]
    unit: Literal["factor"]
    source: Source


class Quantity(Strict):
    """A number of seconds or tasks."""

    value: Annotated[float, Field(ge=-1e6, le=1e6, description="a number")]
    unit: Literal["s", "tasks"]
    source: Source


class Deviation(Strict):
    """A standard deviation in seconds or tasks."""

    value: Annotated[float, Field(ge=0, le=1e6, description="0 or more")]
    unit: Literal["s", "tasks"]
    source: Source


class Thresholds(Strict):
    """The thresholds between neighbouring ratings of an item, strictly ascending."""

    values: Annotated[tuple[float, ...], Field(min_length=1, max_length=200)]
    unit: Literal["logits"]
    source: Source

    @model_validator(mode="after")
    def _ascend(self) -> Self:
        if any(one >= other for one, other in pairwise(self.values)):
            raise refusal(
                "The thresholds do not ascend, so some rating would be impossible.",
                value=list(self.values),
                valid="each threshold above the one before",
                remedy="Sort them, and give none twice.",
                at=("values",),
            )
        return self


class ItemAssumptions(Strict):
    """What is assumed of one item if it differs from the others."""

    discrimination: Factor | None = None
    thresholds: Thresholds | None = None


class Answering(Strict):
    """How an instrument's Likert items are answered: the graded response model.

    `effects`: by condition, on the trait; the condition with 0 is the one the others are measured
    against. `limbs`: shift of a task. `persons`, `reactions`, `moments`: SDs between people, of
    their reactions to a condition, and from task to task. `carry_over`: share of the previous
    condition's effect that is still there. `period`: shift from one block to the next.
    `straight_lining`: share of forms with one rating throughout, each rating equally likely.
    `discrimination`, `thresholds`: of every item that is not in `items`. Reverse-keyed items are
    rated for the opposite of the trait.
    """

    instrument: Key
    effects: dict[Key, Logits]
    limbs: Annotated[dict[Limb, Logits], Field(default_factory=dict)]
    persons: Spread
    reactions: Spread
    moments: Spread
    carry_over: SignedShare
    period: Logits
    straight_lining: Share
    discrimination: Factor
    thresholds: Thresholds
    items: Annotated[dict[Key, ItemAssumptions], Field(default_factory=dict)]


class Performance(Strict):
    """What a measure that is no score is assumed to be, as for `Answering` but in its own unit.

    `means`: by limb and condition. Values below 0 become 0, and tasks are rounded to whole ones.
    """

    means: dict[Limb, dict[Key, Quantity]]
    persons: Deviation
    reactions: Deviation
    moments: Deviation
    carry_over: SignedShare
    period: Quantity


class Assumptions(Strict):
    """All that a simulation of one study assumes.

    `study`: the study's key. `dropout`: probability of stopping in a block, the same in each.
    `excluded`: probability that a completed session is excluded for a technical reason.
    `preregistration`: the analysis that a study without one might declare.
    """

    study: str
    dropout: Share
    excluded: Share
    answering: Answering | None = None
    performance: Annotated[
        dict[Literal["contact_time", "completions"], Performance], Field(default_factory=dict)
    ]
    preregistration: Preregistration | None = None

    def stated(self) -> list[dict[str, object]]:
        """Return every number as {name, value, unit, source}, in the order of the file."""
        return list(_stated("", self.model_dump(mode="json", exclude={"preregistration"})))


def _stated(name: str, node: Plain) -> Iterator[dict[str, object]]:
    if not isinstance(node, dict):
        return
    if "source" in node:
        value = node.get("value", node.get("values"))
        yield {"name": name, "value": value, "unit": node["unit"], "source": node["source"]}
        return
    for key, inner in node.items():
        yield from _stated(f"{name}.{key}" if name else str(key), inner)


def declared_analysis(study: StudyProtocol, assumptions: Assumptions) -> Preregistration | None:
    """Return the study's preregistration, or what the assumptions say that it might declare."""
    return study.preregistration or assumptions.preregistration


def assumption_problems(
    given: Assumptions, study: StudyProtocol, instruments: Mapping[str, Instrument]
) -> Iterator[DefinitionProblem]:
    """Yield what does not fit between valid assumptions and the study they are for."""
    if given.study != study.key:
        yield DefinitionProblem(
            ("study",),
            f"These assumptions are for another study, not for {study.key!r}.",
            given.study,
            study.key,
            "Give the assumptions of the study, or correct the key.",
        )
        return
    declared = declared_analysis(study, given)
    if declared is None:
        yield DefinitionProblem(
            ("preregistration",),
            "Neither the study nor this file declares a test, so there is no power to compute.",
            None,
            "preregistration with alpha, planned_n and primary",
            "Declare it in the study, or here to try one out: docs/preregistration.md.",
        )
        return
    if study.preregistration is not None and given.preregistration is not None:
        yield DefinitionProblem(
            ("preregistration",),
            "The study declares its own test, which this section cannot replace.",
            None,
            "no preregistration here",
            "Remove the section.",
        )
    conditions = [one.key for one in study.conditions]
    if declared.primary.measure == "score":
        yield from _answering(given.answering, declared, conditions, instruments)
    else:
        limbs = _limbs_of(declared, study)
        performance = given.performance.get(declared.primary.measure)
        yield from _performance(performance, declared.primary.measure, limbs, conditions)


def _limbs_of(declared: Preregistration, study: StudyProtocol) -> list[str]:
    limbs = [phase.limb for phase in study.procedure.block.phases]
    wanted = declared.primary.limb
    return [limb for limb in limbs if wanted in (limb, "both")]


def _answering(
    given: Answering | None,
    declared: Preregistration,
    conditions: list[str],
    instruments: Mapping[str, Instrument],
) -> Iterator[DefinitionProblem]:
    key, score = declared.primary.instrument or "", declared.primary.score or ""
    if given is None:
        yield DefinitionProblem(
            ("answering",),
            f"The declared test is of a score of {key!r}, but nothing says how it is answered.",
            None,
            "a section answering",
            "Describe how items are answered; docs/pilot.md has an example.",
        )
        return
    if given.instrument != key:
        yield DefinitionProblem(
            ("answering", "instrument"),
            f"The declared test is of a score of {key!r}.",
            given.instrument,
            [key],
            f"Use {key}.",
        )
        return
    yield from _all_of(("answering", "effects"), list(given.effects), conditions, "condition")
    instrument = instruments[key]
    likert = {item.key: item for item in instrument.items if item.type == "likert"}
    for item in given.items:
        if item not in likert:
            yield _unknown(("answering", "items", item), item, list(likert), "Likert item")
    yield from _thresholds(given, instrument, likert)
    others = _items_of(instrument, score) - likert.keys()
    if others:
        yield DefinitionProblem(
            ("answering", "instrument"),
            f"The score {score!r} needs items that are not Likert items: "
            f"{', '.join(sorted(others))}. The model answers Likert items only.",
            key,
            "a score of Likert items",
            "Such a score cannot be simulated.",
        )


def _thresholds(
    given: Answering, instrument: Instrument, likert: Mapping[str, Item]
) -> Iterator[DefinitionProblem]:
    reported: set[Path] = set()
    for key, item in likert.items():
        own = given.items.get(key)
        stated = own.thresholds if own is not None else None
        path: Path = ("answering", "items", key) if stated is not None else ("answering",)
        scale = item.scale or instrument.scale
        needed = len(scale.steps) - 1 if scale is not None else 0
        found = len((stated or given.thresholds).values)
        if found != needed and path not in reported:
            reported.add(path)
            yield DefinitionProblem(
                (*path, "thresholds", "values"),
                f"The item {key!r} has {needed + 1} ratings, so {needed} thresholds are between "
                f"them; there are {found}.",
                found,
                f"{needed} numbers",
                "Give one for each pair of neighbouring ratings, or the item thresholds of "
                "its own under items.",
            )


def _items_of(instrument: Instrument, score: str) -> set[str]:
    """Return the items that a score is computed from, also through other scores."""
    found: set[str] = set()
    waiting = [score]
    while waiting:
        for name in names_in(instrument.formulas[waiting.pop()]):
            if name in instrument.formulas:
                waiting.append(name)
            else:
                found.add(name)
    return found


def _performance(
    given: Performance | None, measure: str, limbs: list[str], conditions: list[str]
) -> Iterator[DefinitionProblem]:
    path: Path = ("performance", measure)
    if given is None:
        yield DefinitionProblem(
            path,
            f"The declared test is of {measure}, but nothing says how large it is.",
            None,
            f"a section {measure} under performance",
            "Give its means by limb and condition; docs/pilot.md has an example.",
        )
        return
    yield from _all_of((*path, "means"), list(given.means), limbs, "limb")
    for limb, means in given.means.items():
        yield from _all_of((*path, "means", limb), list(means), conditions, "condition")
    unit = UNITS[measure]
    units: dict[Path, str] = {
        ("persons",): given.persons.unit,
        ("reactions",): given.reactions.unit,
        ("moments",): given.moments.unit,
        ("period",): given.period.unit,
        **{
            ("means", limb, key): one.unit
            for limb, means in given.means.items()
            for key, one in means.items()
        },
    }
    for inner, stated in units.items():
        if stated != unit:
            yield DefinitionProblem(
                (*path, *inner, "unit"),
                f"{measure} is in {unit}, not in {stated}.",
                stated,
                [unit],
                f"Say {unit}, and check the number.",
            )


def _all_of(
    path: Path, given: list[str], wanted: list[str], what: str
) -> Iterator[DefinitionProblem]:
    for key in given:
        if key not in wanted:
            yield _unknown((*path, key), key, wanted, what)
    missing = [key for key in wanted if key not in given]
    if missing:
        yield DefinitionProblem(
            path,
            f"There is no number for the {what} {', '.join(missing)}.",
            given,
            wanted,
            f"Give every {what} a number; 0 is one, too.",
        )


def _unknown(path: Path, key: str, valid: list[str], what: str) -> DefinitionProblem:
    return DefinitionProblem(
        path,
        f"The study has no {what} {key!r}.",
        key,
        valid,
        f"Use one of: {', '.join(valid)}.",
    )

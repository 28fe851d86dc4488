"""Whether a declared test can ever be made: its measure is asked, its condition exists."""

from collections.abc import Iterator, Mapping

from app.protocol.source import Path, Plain
from app.science.instruments import DefinitionProblem, Instrument

_PRIMARY: Path = ("preregistration", "primary")
_FEWEST_FOR_ALL = 3


def preregistration_problems(
    tree: Mapping[str, Plain], instruments: Mapping[str, Instrument]
) -> Iterator[DefinitionProblem]:
    """A measure that is not asked after the task, an unknown score, limb or reference."""
    primary = _dict(_dict(tree.get("preregistration")).get("primary"))
    if not primary:
        return
    phases = [_dict(one) for one in _list(_dict(_block(tree)).get("phases"))]
    yield from _limb(primary, phases)
    yield from _score(primary, phases, instruments)
    yield from _conditions(primary, tree)


def _limb(primary: dict[str, Plain], phases: list[dict[str, Plain]]) -> Iterator[DefinitionProblem]:
    limb = primary.get("limb")
    limbs = sorted({str(one.get("limb")) for one in phases})
    if isinstance(limb, str) and limb in ("hand", "foot") and limb not in limbs:
        yield DefinitionProblem(
            (*_PRIMARY, "limb"),
            f"The study has no task with the {limb}.",
            limb,
            limbs,
            f"Use one of: {', '.join(limbs)}.",
        )
    if limb == "both" and len(limbs) == 1:
        yield DefinitionProblem(
            (*_PRIMARY, "limb"),
            "The study has tasks with one limb only.",
            limb,
            limbs,
            f"Say {limbs[0]}.",
        )


def _score(
    primary: dict[str, Plain],
    phases: list[dict[str, Plain]],
    instruments: Mapping[str, Instrument],
) -> Iterator[DefinitionProblem]:
    key, score = primary.get("instrument"), primary.get("score")
    if not isinstance(key, str):
        return
    wanted = [one for one in phases if primary.get("limb") in (one.get("limb"), "both")]
    asked = sorted({str(one.get("questionnaire")) for one in wanted})
    if wanted and asked != [key]:
        yield DefinitionProblem(
            (*_PRIMARY, "instrument"),
            f"{key!r} is not what is asked after the task.",
            key,
            asked,
            f"Use one of: {', '.join(asked)}.",
        )
    known = [one.key for one in instruments[key].scores] if key in instruments else []
    if known and isinstance(score, str) and score not in known:
        yield DefinitionProblem(
            (*_PRIMARY, "score"),
            f"The instrument {key!r} has no score {score!r}.",
            score,
            known,
            f"Use one of: {', '.join(known)}.",
        )


def _conditions(
    primary: dict[str, Plain], tree: Mapping[str, Plain]
) -> Iterator[DefinitionProblem]:
    keys = [str(_dict(one).get("key")) for one in _list(tree.get("conditions"))]
    reference, test = primary.get("reference"), primary.get("test")
    if isinstance(reference, str) and reference not in keys:
        yield DefinitionProblem(
            (*_PRIMARY, "reference"),
            f"There is no condition {reference!r}.",
            reference,
            keys,
            f"Use one of: {', '.join(keys)}.",
        )
    if test in ("friedman", "page_trend") and 0 < len(keys) < _FEWEST_FOR_ALL:
        yield DefinitionProblem(
            (*_PRIMARY, "test"),
            f"The test {test} needs three conditions; the study has {len(keys)}.",
            test,
            ["against_reference", "rm_anova"],
            "Use against_reference with one of the conditions.",
        )


def _block(tree: Mapping[str, Plain]) -> Plain:
    return _dict(tree.get("procedure")).get("block")


def _dict(value: Plain) -> dict[str, Plain]:
    return value if isinstance(value, dict) else {}


def _list(value: Plain) -> list[Plain]:
    return value if isinstance(value, list) else []

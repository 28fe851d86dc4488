"""Check what must be consistent across a study file: references, languages, size of the design.

These checks read the plain tree and skip values of an unexpected shape (that problem is reported
elsewhere). So they run even when another value is wrong, and all problems of a file are reported
together. They also check whether a named avatar exists and matches how it is moved, and whether
named bodies and pictures exist.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping

from pydantic import ValidationError

from app.protocol.avatar_changes import AvatarChanges, change_problems
from app.protocol.common import TEXT_MARK
from app.protocol.conditions import MAX_PERMUTED
from app.protocol.preregistration import preregistration_problems
from app.protocol.safety import asked_instruments, body_problems, safety_problems
from app.protocol.schema import Schema, marked_places
from app.protocol.simulation import simulation_problems
from app.protocol.source import Path, Plain
from app.protocol.study import SCREEN_TEXTS
from app.protocol.validity import validity_problems
from app.protocol.wording import mark_problems
from app.science.avatar.configuration import Configuration, missing_part_problems
from app.science.instruments import DefinitionProblem, Instrument, text_problems
from app.texts import LANGUAGES

ConfigurationOf = Callable[[str, int], Configuration | None]
"""A function from an avatar's key and version to its configuration, or None if there is none."""
_AVATAR_KEY = "avatar_configuration"
_AVATAR_AT: Path = (_AVATAR_KEY,)
_USUAL_AVATAR = "standard"
# The pictures that texts can show on the tablet: `![t_pose]`, alone on a line. The tablet
# draws them; `frontend/src/shared/pictures.ts` has the same names.
PICTURES = ("equipment", "t_pose", "mirror", "hand_boxes", "foot_boxes")
_PICTURE = re.compile(r"^\s*!\[([^\]\n]*)\]\s*$", re.MULTILINE)


def cross_problems(
    tree: Plain,
    schema: Schema,
    instruments: Mapping[str, Instrument],
    avatars: Mapping[str, int] | None = None,
    bodies: Mapping[str, str] | None = None,
    configured: ConfigurationOf | None = None,
) -> Iterator[DefinitionProblem]:
    """Yield every problem between two places of a study file, or between it and the lab's data."""
    if not isinstance(tree, dict):
        return
    languages = [one for one in _list(tree.get("languages")) if isinstance(one, str)]
    yield from _texts(tree, schema, languages)
    yield from _screens(tree)
    yield from _references(tree, instruments, languages)
    yield from _titles(tree, languages)
    yield from _places(tree)
    yield from _road(tree)
    yield from _rows(tree)
    yield from _sequences(tree)
    yield from safety_problems(tree, instruments)
    yield from simulation_problems(tree, instruments, asked_instruments(tree))
    yield from body_problems(tree)
    yield from validity_problems(tree)
    yield from avatar_problems(tree, avatars)
    yield from worn_body_problems(tree, bodies)
    yield from same_body_problems(tree, bodies, configured)
    yield from incomplete_avatar_problems(tree, configured)
    yield from changed_avatar_problems(tree, configured)
    yield from preregistration_problems(tree, instruments)


def _texts(tree: Plain, schema: Schema, languages: list[str]) -> Iterator[DefinitionProblem]:
    avatar = tree.get("avatar") if isinstance(tree, dict) else None
    for path, text in marked_places(schema, tree, TEXT_MARK):
        if isinstance(text, dict):
            wordings = {key: words for key, words in text.items() if isinstance(words, str)}
            spoken = [one for one in languages if one not in text or one in wordings]
            yield from text_problems(path, wordings, spoken)
            yield from picture_problems(path, wordings)
            yield from mark_problems(path, wordings, avatar)


def _screens(tree: dict[str, Plain]) -> Iterator[DefinitionProblem]:
    texts = tree.get("texts")
    for key in SCREEN_TEXTS:
        if isinstance(texts, dict) and key not in texts:
            yield DefinitionProblem(
                ("texts", key),
                f"The text {key!r} is missing; devices show it between the steps.",
                None,
                list(SCREEN_TEXTS),
                "Add it in every language.",
            )


def _steps(tree: dict[str, Plain]) -> Iterator[tuple[Path, dict[str, Plain]]]:
    """Yield every step and phase that is a mapping, with its path."""
    procedure = _dict(tree.get("procedure"))
    places: tuple[tuple[Path, Plain], ...] = (
        (("procedure", "before"), procedure.get("before")),
        (("procedure", "block", "phases"), _dict(procedure.get("block")).get("phases")),
        (("procedure", "block", "after"), _dict(procedure.get("block")).get("after")),
        (("procedure", "after"), procedure.get("after")),
    )
    for path, steps in places:
        for index, step in enumerate(_list(steps)):
            if isinstance(step, dict):
                yield (*path, index), step
    crossing = _dict(procedure.get("block")).get("crossing")
    if isinstance(crossing, dict):
        yield ("procedure", "block", "crossing"), crossing


def _references(
    tree: dict[str, Plain], instruments: Mapping[str, Instrument], languages: list[str]
) -> Iterator[DefinitionProblem]:
    texts = tree.get("texts")
    for path, step in _steps(tree):
        text = step.get("text")
        if isinstance(text, str) and isinstance(texts, dict) and text not in texts:
            yield DefinitionProblem(
                (*path, "text"),
                f"There is no text {text!r}.",
                text,
                sorted(texts),
                f"Add it under texts, or use one of: {', '.join(sorted(texts))}.",
            )
        for field in ("instrument", "questionnaire"):
            key = step.get(field)
            if isinstance(key, str):
                yield from _instrument((*path, field), key, instruments, languages)


def _instrument(
    path: Path, key: str, instruments: Mapping[str, Instrument], languages: list[str]
) -> Iterator[DefinitionProblem]:
    if key not in instruments:
        valid = ", ".join(sorted(instruments)) or "none is loaded"
        yield DefinitionProblem(
            path,
            f"There is no instrument {key!r}.",
            key,
            sorted(instruments),
            f"Add its file to the instruments, or use one of: {valid}.",
        )
        return
    spoken = instruments[key].languages
    for language in languages:
        if language not in spoken:
            yield DefinitionProblem(
                path,
                f"The instrument {key!r} has no wording in the study's language {language!r}.",
                key,
                list(spoken),
                f"Translate the instrument, or remove {language} from the study's languages.",
            )


def _titles(tree: dict[str, Plain], languages: list[str]) -> Iterator[DefinitionProblem]:
    """Yield a problem for each missing title.

    Built-in titles exist in two languages, so any other language needs a title of its own.
    """
    foreign = [language for language in languages if language not in LANGUAGES]
    for path, step in _steps(tree):
        fields = ("title", "questionnaire_title") if "questionnaire" in step else ("title",)
        for field in fields:
            if foreign and step.get(field) is None:
                yield DefinitionProblem(
                    (*path, field),
                    f"There is no built-in title in the language {foreign[0]!r}.",
                    None,
                    sorted(LANGUAGES),
                    f"Give this step a {field} in every language.",
                )


def _places(tree: dict[str, Plain]) -> Iterator[DefinitionProblem]:
    """Yield a problem for each task without boxes whose limb a phase uses."""
    tasks = tree.get("tasks")
    if not isinstance(tasks, dict):
        return
    used = {limb for _, step in _steps(tree) if isinstance(limb := step.get("limb"), str)}
    for limb in ("hand", "foot"):
        if limb in used and tasks.get(limb) is None:
            yield DefinitionProblem(
                ("tasks", limb),
                f"The procedure has a phase of the {limb}, but its boxes are missing.",
                None,
                sorted(used),
                f"Describe the boxes under tasks.{limb}, or remove the phase.",
            )


def _road(tree: dict[str, Plain]) -> Iterator[DefinitionProblem]:
    """Yield a problem if there is a crossing without a road, or a road that nobody crosses."""
    has_crossing = _dict(_dict(tree.get("procedure")).get("block")).get("crossing") is not None
    if has_crossing and tree.get("road") is None:
        yield DefinitionProblem(
            ("road",),
            "The procedure has a crossing, but the road is missing.",
            None,
            "a road with its partners",
            "Describe it under road, or remove procedure.block.crossing.",
        )
    if not has_crossing and tree.get("road") is not None:
        yield DefinitionProblem(
            ("road",),
            "The study has a road, but no block has a crossing.",
            None,
            "left out",
            "Add procedure.block.crossing, or remove the road.",
        )


def _rows(tree: dict[str, Plain]) -> Iterator[DefinitionProblem]:
    n_conditions = len(_list(tree.get("conditions")))
    if _dict(tree.get("orders")).get("design") == "all_permutations" and (
        n_conditions > MAX_PERMUTED
    ):
        rows = math.factorial(n_conditions) if n_conditions < 20 else "far too many"
        yield DefinitionProblem(
            ("orders", "design"),
            f"All orders of {n_conditions} conditions make {rows} rows for each replicate.",
            n_conditions,
            f"at most {MAX_PERMUTED} conditions ({math.factorial(MAX_PERMUTED)} rows)",
            "Use fewer conditions, or the design williams, which needs fewer rows.",
        )


def _sequences(tree: dict[str, Plain]) -> Iterator[DefinitionProblem]:
    """Yield problems of explicit orders: each lists all conditions; other designs have no list."""
    orders = _dict(tree.get("orders"))
    listed = orders.get("sequences")
    if (orders.get("design") == "explicit") != (listed is not None):
        yield DefinitionProblem(
            ("orders", "sequences"),
            "Orders must be listed for the design explicit, and only for that.",
            orders.get("design"),
            "a list of orders with the design explicit, none otherwise",
            "Give the orders as lists of condition keys, or leave them out.",
        )
    keys = sorted(str(_dict(one).get("key")) for one in _list(tree.get("conditions")))
    if isinstance(listed, list) and not listed:
        yield DefinitionProblem(
            ("orders", "sequences"), "No order is listed.", [], ">= 1 order", "List an order."
        )
    for at, sequence in enumerate(_list(listed)):
        if sequence in _list(listed)[:at]:
            yield DefinitionProblem(
                ("orders", "sequences", at),
                "This order is listed twice.",
                sequence,
                "every order once",
                "List it once; replicates sets how often every order is used.",
            )
        if sorted(map(str, _list(sequence))) != keys:
            yield DefinitionProblem(
                ("orders", "sequences", at),
                "An order must contain every condition once.",
                sequence,
                keys,
                "Name each condition's key once.",
            )


def _dict(value: Plain) -> dict[str, Plain]:
    return value if isinstance(value, dict) else {}


def _list(value: Plain) -> list[Plain]:
    return value if isinstance(value, list) else []


def avatar_problems(
    tree: Mapping[str, Plain], avatars: Mapping[str, int] | None
) -> Iterator[DefinitionProblem]:
    """Yield avatar problems: physics needs a configuration, a delayed copy must not have one.

    Args:
        tree: the tree of the study file.
        avatars: key -> number of the newest version; None if unknown.
    """
    moved, named = tree.get("avatar"), tree.get(_AVATAR_KEY)
    keys = sorted(avatars or ())
    example = _USUAL_AVATAR if _USUAL_AVATAR in keys or not keys else keys[0]
    if moved == "physics" and named is None:
        yield DefinitionProblem(
            _AVATAR_AT,
            "The avatar is moved by physics, but its configuration is not named.",
            None,
            keys,
            f"Add for example {_AVATAR_KEY}: {{key: {example}, version: 1}}.",
        )
    if moved == "delayed_copy" and named is not None:
        yield DefinitionProblem(
            _AVATAR_AT,
            "A delayed copy has no configuration: it would have no effect.",
            None,
            "left out",
            "Remove it, or write avatar: physics.",
        )
    if isinstance(named, dict) and avatars is not None:
        yield from _unknown_avatar(named.get("key"), named.get("version"), avatars)


def _unknown_avatar(
    key: Plain, version: Plain, avatars: Mapping[str, int]
) -> Iterator[DefinitionProblem]:
    if not isinstance(key, str):
        return
    if key not in avatars:
        keys = sorted(avatars)
        yield DefinitionProblem(
            (*_AVATAR_AT, "key"),
            f"There is no avatar {key!r}.",
            key,
            keys,
            f"Use one of: {', '.join(keys)}.",
        )
    elif isinstance(version, int) and version > avatars[key]:
        yield DefinitionProblem(
            (*_AVATAR_AT, "version"),
            f"The avatar {key!r} has no version {version}.",
            version,
            f"1 to {avatars[key]}",
            "Name a version that was saved.",
        )


def incomplete_avatar_problems(
    tree: dict[str, Plain], configured: ConfigurationOf | None
) -> Iterator[DefinitionProblem]:
    """Yield a problem if the named avatar lacks parts that the tasks and the headset need.

    Earlier releases stored such avatars.

    Args:
        tree: the tree of the study file.
        configured: the configurations of avatars; None if they are unknown.
    """
    configuration = _configuration_of(tree, configured)
    if configuration is None:
        return
    named = _dict(tree.get(_AVATAR_KEY))
    for one in missing_part_problems(configuration):
        yield DefinitionProblem(
            (*_AVATAR_AT, "version"),
            f"Version {named['version']} of the avatar {named['key']!r} cannot be used: "
            f"{one.message}",
            named["version"],
            one.valid,
            "Name another version, or save one in which these parts have all their axes.",
        )


def changed_avatar_problems(
    tree: dict[str, Plain], configured: ConfigurationOf | None
) -> Iterator[DefinitionProblem]:
    """Yield a problem for each change to the avatar that would have no effect in its phase.

    Args:
        tree: the tree of the study file.
        configured: the configurations of avatars; None if they are unknown.
    """
    configuration = _configuration_of(tree, configured)
    for path, step in _steps(tree):
        content = step.get("avatar_changes")
        if content is None:
            continue
        here: Path = (*path, "avatar_changes")
        if tree.get("avatar") == "delayed_copy":
            yield DefinitionProblem(
                here,
                "A delayed copy has no motors or colliders, so there is nothing to change.",
                None,
                "left out, or avatar: physics",
                "Remove it, or write avatar: physics.",
            )
        elif configuration is not None:
            try:
                changes = AvatarChanges.model_validate(content)
            except ValidationError:
                continue  # reported with the other values of an unexpected shape
            for one in change_problems(configuration, changes):
                yield DefinitionProblem(
                    (*here, *_parts_of_path(one.path)),
                    one.message,
                    one.value,
                    one.valid,
                    one.remedy,
                )


def _configuration_of(
    tree: dict[str, Plain], configured: ConfigurationOf | None
) -> Configuration | None:
    named = _dict(tree.get(_AVATAR_KEY))
    key, version = named.get("key"), named.get("version")
    if configured is None or not isinstance(key, str) or not isinstance(version, int):
        return None
    return configured(key, version)


def _parts_of_path(path: str) -> Path:
    """Parse a path: `casts[0].group` is ("casts", 0, "group")."""
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", path))


def worn_body_problems(
    tree: Mapping[str, Plain], bodies: Mapping[str, str] | None
) -> Iterator[DefinitionProblem]:
    """Yield a problem for each condition whose body does not exist or would not be worn.

    Args:
        tree: the tree of the study file.
        bodies: the hash of each body's model, by name; None if unknown.
    """
    for index, condition in enumerate(_list(tree.get("conditions"))):
        name = _dict(condition).get("body")
        if not isinstance(name, str):
            continue
        path: Path = ("conditions", index, "body")
        if tree.get("avatar") == "delayed_copy":
            yield DefinitionProblem(
                path,
                "A delayed copy wears no body, so this setting would have no effect.",
                name,
                "left out, or avatar: physics",
                "Remove it, or write avatar: physics.",
            )
        elif bodies is not None and name not in bodies:
            names = ", ".join(sorted(bodies)) or "no body has a name yet"
            yield DefinitionProblem(
                path,
                f"There is no body {name!r}.",
                name,
                sorted(bodies),
                f"Name it on the page Bodies, or use one of: {names}.",
            )


def _number(value: Plain) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def same_body_problems(
    tree: dict[str, Plain],
    bodies: Mapping[str, str] | None,
    configured: ConfigurationOf | None,
) -> Iterator[DefinitionProblem]:
    """Yield a problem for each condition that names the body which another one wears unnamed.

    A condition without a body wears that of the avatar configuration, so both are one condition.

    Args:
        tree: the tree of the study file.
        bodies: the hash of each body's model, by name; None if unknown.
        configured: the configurations of avatars; None if they are unknown.
    """
    configuration = _configuration_of(tree, configured)
    if bodies is None or configuration is None or configuration.humanoid is None:
        return
    conditions = [_dict(one) for one in _list(tree.get("conditions"))]
    unnamed = {_number(one.get("latency_ms")) for one in conditions if one.get("body") is None}
    for index, condition in enumerate(conditions):
        name, latency_ms = condition.get("body"), _number(condition.get("latency_ms"))
        if not isinstance(name, str) or bodies.get(name) != configuration.humanoid:
            continue
        if latency_ms is not None and latency_ms in unnamed:
            yield DefinitionProblem(
                ("conditions", index, "body"),
                f"{name!r} is the body of the avatar configuration, which another condition with "
                f"{latency_ms:g} ms wears because it names none, so no analysis can tell them "
                "apart.",
                name,
                "a different latency or a different body for each condition",
                "Change or remove one of them, or give them different bodies.",
            )


def picture_problems(path: Path, wordings: Mapping[str, str]) -> Iterator[DefinitionProblem]:
    """Yield a problem for each named picture that does not exist.

    It would be missing from the instructions.
    """
    for language, words in wordings.items():
        for name in _PICTURE.findall(words):
            if name not in PICTURES:
                yield DefinitionProblem(
                    (*path, language),
                    f"There is no picture {name!r}.",
                    name,
                    list(PICTURES),
                    f"Use one of: {', '.join(PICTURES)}; or remove the line.",
                )

"""Whether the avatar that a study names goes with how it is moved, and exists."""

from collections.abc import Iterator, Mapping

from app.protocol.source import Path, Plain
from app.science.instruments import DefinitionProblem

_KEY = "avatar_configuration"
_AT: Path = (_KEY,)
_USUAL = "standard"


def avatar_problems(
    tree: Mapping[str, Plain], avatars: Mapping[str, int] | None
) -> Iterator[DefinitionProblem]:
    """A physics avatar needs a configuration, a delayed copy has none.

    Args:
        tree: of the study file.
        avatars: key -> number of its newest version; None where nobody knows which there are.
    """
    moved, named = tree.get("avatar"), tree.get(_KEY)
    known = sorted(avatars or ())
    example = _USUAL if _USUAL in known or not known else known[0]
    if moved == "physics" and named is None:
        yield DefinitionProblem(
            _AT,
            "The avatar is moved by physics, but its configuration is not named.",
            None,
            known,
            f"Add for example {_KEY}: {{key: {example}, version: 1}}.",
        )
    if moved == "delayed_copy" and named is not None:
        yield DefinitionProblem(
            _AT,
            "A delayed copy has no configuration: nothing of it would be used.",
            None,
            "left out",
            "Take it out, or write avatar: physics.",
        )
    if isinstance(named, dict) and avatars is not None:
        yield from _unknown(named.get("key"), named.get("version"), avatars)


def _unknown(key: Plain, version: Plain, avatars: Mapping[str, int]) -> Iterator[DefinitionProblem]:
    if not isinstance(key, str):
        return
    if key not in avatars:
        known = sorted(avatars)
        yield DefinitionProblem(
            (*_AT, "key"),
            f"There is no avatar {key!r}.",
            key,
            known,
            f"Use one of: {', '.join(known)}.",
        )
    elif isinstance(version, int) and version > avatars[key]:
        yield DefinitionProblem(
            (*_AT, "version"),
            f"The avatar {key!r} has no version {version}.",
            version,
            f"1 to {avatars[key]}",
            "Name a version that was saved.",
        )

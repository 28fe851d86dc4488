"""Shared parts of study files: frozen strict models, texts, keys, durations and hashes.

Equal content has one canonical form, so that a hash identifies the content and not its formatting.
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from pydantic_core import PydanticCustomError

TEXT_MARK = "x-text"
"""Marks, in the JSON schema, the mappings that must contain every declared language."""

_KEY = r"^[a-z][a-z0-9_]{0,39}$"
_MAX_DURATION_S = 86_400.0

Text = Annotated[Mapping[str, str], Field(min_length=1, json_schema_extra={TEXT_MARK: True})]
"""Language code -> wording for participants and operators."""

Key = Annotated[
    str,
    StringConstraints(pattern=_KEY),
    Field(description="lower-case letters, digits and _, beginning with a letter, at most 40"),
]
Duration = Annotated[float, Field(gt=0, le=_MAX_DURATION_S, description="seconds, above 0")]
Pause = Annotated[float, Field(ge=0, le=_MAX_DURATION_S, description="seconds; 0 for none")]
Length = Annotated[float, Field(gt=0, le=10, description="metres, above 0")]
Point = Annotated[
    tuple[float, float, float],
    Field(description="[x, y, z] in metres: x to the right, y up, -z ahead, from the start square"),
]


class Strict(BaseModel):
    """A frozen model that rejects unknown keys and converts nothing implicitly."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class Provenance(Strict):
    """The source of a study, its licence, and how far they were verified."""

    source: str
    licence: str
    verified: str
    notes: tuple[str, ...] = ()


def refusal(
    message: str,
    *,
    value: object = None,
    valid: object = None,
    remedy: str = "",
    at: tuple[str | int, ...] = (),
) -> PydanticCustomError:
    """Make the error that a validator raises: what happened, the value, what is valid, what to do.

    `at`: the place within the validated value, such as (1, "key").
    """
    context: dict[str, Any] = {
        "said": message, "value": value, "valid": valid, "remedy": remedy, "at": at,
    }  # fmt: skip
    return PydanticCustomError("refused", "{said}", context)


def canonical_json(value: object) -> str:
    """Return JSON with sorted keys, no whitespace and unescaped letters.

    Raise ValueError for NaN.
    """
    return json.dumps(
        value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    )


def sha256_of(text: str) -> str:
    """Return the SHA-256 of the text's UTF-8 bytes, as 64 hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()

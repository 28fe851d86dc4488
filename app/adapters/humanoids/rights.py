"""Read who made a model, and what they allow others to do with it.

VRM files say so in their `meta`, in a different form for each version. Other glTF files have at
most `asset.copyright`, and what programs and sites write into `asset.extras` (Sketchfab: author,
licence and source). What a file does not state is unknown, except in VRM 1.0, whose specification
forbids everything that is not allowed.

VRoid Hub, from which many VRM 0 files come, writes its terms into the address of the licence.

If two statements of a file disagree, such as a licence that excludes commercial use and a
permission for it, the stricter one counts.

Source: VRM consortium, VRM 0.0 `meta`; VRM 1.0 `VRMC_vrm` `meta`; Creative Commons 4.0 licences.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Final, Literal
from urllib.parse import parse_qsl, urlsplit

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    field_validator,
    model_validator,
)
from pydantic_core import PydanticUseDefault

Permission = Literal["allowed", "forbidden", "unknown"]
Wearers = Literal["author", "licensed", "everyone", "unknown"]
"""Who may wear a model: its author, people with a permission of their own, or everyone."""
_LONGEST: Final = 1_000
_MOST_AUTHORS: Final = 30
_Text = Annotated[str, Field(max_length=10_000)]


@dataclass(frozen=True)
class ModelRights:
    """Who made a model, and what may be done with it; texts are as in the file, empty if absent.

    Attributes:
        title, authors, contact: of the model; `authors` is empty if they are not named.
        copyright: a notice for those who show the model.
        licence: its name, such as `CC_BY`.
        licence_url, other_url: where its terms are, and further ones.
        wearers: who may wear it.
        violent, sexual, political, antisocial: whether it may be used for excessively violent or
            sexual acts, for political or religious purposes, and for antisocial or hateful ones.
        commercial: commercial use.
        redistribution: passing on the file.
        modification: changing the file.
        credit_needed: whether the authors must be named; None if unknown.
    """

    title: str = ""
    authors: tuple[str, ...] = ()
    contact: str = ""
    copyright: str = ""
    licence: str = ""
    licence_url: str = ""
    other_url: str = ""
    wearers: Wearers = "unknown"
    violent: Permission = "unknown"
    sexual: Permission = "unknown"
    political: Permission = "unknown"
    antisocial: Permission = "unknown"
    commercial: Permission = "unknown"
    redistribution: Permission = "unknown"
    modification: Permission = "unknown"
    credit_needed: bool | None = None

    @property
    def wearing_needs_permission(self) -> bool:
        """Return whether people other than the author may wear it only with a permission.

        A laboratory that uses such a model has to confirm that it is the author or has the
        permission; the product asks before participants wear it.
        """
        return self.wearers in ("author", "licensed")


class _Meta(BaseModel):
    """Statements of a file, each optional; one that is not valid counts as not made.

    Invalid statements must neither keep the body from being read nor hide the valid ones, above
    all not who may wear it.
    """

    model_config = ConfigDict(strict=True)

    @model_validator(mode="before")
    @classmethod
    def _object_or_nothing(cls, value: object) -> object:
        return value if isinstance(value, dict) else {}

    @field_validator("*", mode="wrap")
    @classmethod
    def _valid_or_default(cls, value: object, read: ValidatorFunctionWrapHandler) -> object:
        try:
            return read(value)
        except ValidationError:
            raise PydanticUseDefault from None


class Vrm0Meta(_Meta):
    """The `meta` of VRM 0."""

    title: _Text = ""
    author: _Text = ""
    contactInformation: _Text = ""  # noqa: N815 - as in the file
    reference: _Text = ""
    allowedUserName: _Text = ""  # noqa: N815
    violentUssageName: _Text = ""  # noqa: N815
    sexualUssageName: _Text = ""  # noqa: N815
    commercialUssageName: _Text = ""  # noqa: N815
    licenseName: _Text = ""  # noqa: N815
    otherPermissionUrl: _Text = ""  # noqa: N815
    otherLicenseUrl: _Text = ""  # noqa: N815


class Vrm1Meta(_Meta):
    """The `meta` of VRM 1.0, with the specification's defaults, which forbid."""

    name: _Text = ""
    authors: Annotated[list[_Text], Field(max_length=1_000)] = []
    copyrightInformation: _Text = ""  # noqa: N815
    contactInformation: _Text = ""  # noqa: N815
    licenseUrl: _Text = ""  # noqa: N815
    otherLicenseUrl: _Text = ""  # noqa: N815
    avatarPermission: Literal[  # noqa: N815
        "onlyAuthor", "onlySeparatelyLicensedPerson", "everyone"
    ] = "onlyAuthor"
    allowExcessivelyViolentUsage: bool = False  # noqa: N815
    allowExcessivelySexualUsage: bool = False  # noqa: N815
    allowPoliticalOrReligiousUsage: bool = False  # noqa: N815
    allowAntisocialOrHateUsage: bool = False  # noqa: N815
    commercialUsage: Literal[  # noqa: N815
        "personalNonProfit", "personalProfit", "corporation"
    ] = "personalNonProfit"
    allowRedistribution: bool = False  # noqa: N815
    modification: Literal["prohibited", "allowModification", "allowModificationRedistribution"] = (
        "prohibited"
    )
    creditNotation: Literal["required", "unnecessary"] = "required"  # noqa: N815


class Asset(_Meta):
    """The `asset` of any glTF file."""

    copyright: _Text = ""
    extras: dict[str, Any] | None = None


_WEARERS_0: Final[Mapping[str, Wearers]] = {
    "OnlyAuthor": "author", "ExplicitlyLicensedPerson": "licensed", "Everyone": "everyone",
}  # fmt: skip
_WEARERS_1: Final[Mapping[str, Wearers]] = {
    "onlyAuthor": "author", "onlySeparatelyLicensedPerson": "licensed", "everyone": "everyone",
}  # fmt: skip
_CREDIT: Final[Mapping[str, bool]] = {
    "necessary": True, "required": True, "unnecessary": False,
}  # fmt: skip
_CC_URLS: Final[Mapping[str, str]] = {
    "CC0": "https://creativecommons.org/publicdomain/zero/1.0/",
    **{
        f"CC_{name.upper().replace('-', '_')}": f"https://creativecommons.org/licenses/{name}/4.0/"
        for name in ("by", "by-nc", "by-sa", "by-nc-sa", "by-nd", "by-nc-nd")
    },
}


def rights_of(asset: Asset, vrm0: Vrm0Meta | None, vrm1: Vrm1Meta | None) -> ModelRights:
    """Return what a file says about its author and the use of the model."""
    if vrm1 is None:
        return _of_gltf(asset) if vrm0 is None else _of_vrm0(vrm0, asset)
    newer = _of_vrm1(vrm1, asset)
    return newer if vrm0 is None else _strictest(newer, _of_vrm0(vrm0, asset))


_STRICT_WEARERS: Final[tuple[Wearers, ...]] = ("author", "licensed", "everyone", "unknown")
_USES: Final = (
    *("violent", "sexual", "political", "antisocial"),
    *("commercial", "redistribution", "modification"),
)


def _strictest(one: ModelRights, other: ModelRights) -> ModelRights:
    """Return the first statement of a file with both, and of each term the stricter one."""
    stricter: dict[str, Any] = {
        use: next((said for said in ("forbidden", getattr(one, use)) if said in pair), "unknown")
        for use in _USES
        if (pair := (getattr(one, use), getattr(other, use)))
    }
    wearers = next(who for who in _STRICT_WEARERS if who in (one.wearers, other.wearers))
    return replace(
        one,
        **stricter,
        wearers=wearers,
        credit_needed=bool(one.credit_needed or other.credit_needed),
    )


def _of_vrm0(meta: Vrm0Meta, asset: Asset) -> ModelRights:
    licence = meta.licenseName
    terms = set(licence.split("_")) if licence in _CC_URLS else set()
    hub = _hub_terms(meta.otherPermissionUrl) or _hub_terms(meta.otherLicenseUrl)
    return ModelRights(
        title=_short(meta.title),
        authors=_authors(meta.author),
        contact=_short(meta.contactInformation),
        copyright=_short(asset.copyright),
        licence=_short(licence),
        licence_url=_address(meta.otherLicenseUrl) or _CC_URLS.get(licence, ""),
        other_url=_address(meta.otherPermissionUrl),
        wearers=_WEARERS_0.get(meta.allowedUserName, "unknown"),
        violent=_stricter(meta.violentUssageName, hub.get("violent_expression")),
        sexual=_stricter(meta.sexualUssageName, hub.get("sexual_expression")),
        commercial=_stricter(
            meta.commercialUssageName,
            hub.get("corporate_commercial_use"),
            "disallow" if "NC" in terms else None,
        ),
        redistribution=_stricter(
            hub.get("redistribution"),
            "disallow" if licence == "Redistribution_Prohibited" else "allow" if terms else None,
        ),
        modification=_stricter(
            hub.get("modification"),
            "disallow" if "ND" in terms else "allow" if terms else None,
        ),
        credit_needed="BY" in terms if terms else _CREDIT.get(hub.get("credit", "")),
    )


def _hub_terms(url: str) -> Mapping[str, str]:
    """Return the terms in the address of a licence at VRoid Hub; none for any other address."""
    try:
        parts = urlsplit(url)
    except ValueError:
        return {}
    return dict(parse_qsl(parts.query)) if parts.hostname == "hub.vroid.com" else {}


def _stricter(*statements: str | None) -> Permission:
    """Return the strictest of several statements about a use: forbidden if any of them says so."""
    said = {(statement or "").lower() for statement in statements}
    return "forbidden" if "disallow" in said else "allowed" if "allow" in said else "unknown"


def _of_vrm1(meta: Vrm1Meta, asset: Asset) -> ModelRights:
    changing: Mapping[str, Permission] = {
        "prohibited": "forbidden",
        "allowModification": "allowed",
        "allowModificationRedistribution": "allowed",
    }
    selling: Mapping[str, Permission] = {
        "personalNonProfit": "forbidden",
        "personalProfit": "allowed",
        "corporation": "allowed",
    }
    return ModelRights(
        title=_short(meta.name),
        authors=_authors(*meta.authors),
        contact=_short(meta.contactInformation),
        copyright=_short(meta.copyrightInformation or asset.copyright),
        licence="VRM Public License 1.0" if "vrm.dev/licenses/1.0" in meta.licenseUrl else "",
        licence_url=_address(meta.licenseUrl),
        other_url=_address(meta.otherLicenseUrl),
        wearers=_WEARERS_1[meta.avatarPermission],
        violent=_allowed(meta.allowExcessivelyViolentUsage),
        sexual=_allowed(meta.allowExcessivelySexualUsage),
        political=_allowed(meta.allowPoliticalOrReligiousUsage),
        antisocial=_allowed(meta.allowAntisocialOrHateUsage),
        commercial=selling[meta.commercialUsage],
        redistribution=_allowed(meta.allowRedistribution),
        modification=changing[meta.modification],
        credit_needed=_CREDIT[meta.creditNotation],
    )


def _of_gltf(asset: Asset) -> ModelRights:
    said = {
        name: _short(value)
        for name, value in (asset.extras or {}).items()
        if isinstance(value, str)
    }
    licence = said.get("license") or said.get("licence") or ""
    return ModelRights(
        title=said.get("title", ""),
        authors=_authors(said.get("author", "")),
        contact=said.get("source", ""),
        copyright=_short(asset.copyright),
        licence=licence,
        # Sketchfab's form: `CC-BY-4.0 (http://creativecommons.org/licenses/by/4.0/)`.
        licence_url=_address(licence.partition("(")[2].rstrip(")")),
    )


def _allowed(value: bool) -> Permission:  # noqa: FBT001 - a statement of the file
    return "allowed" if value else "forbidden"


def _authors(*names: str) -> tuple[str, ...]:
    known = [short for name in names if (short := _short(name))]
    kept, length = [], 0
    for name in known[:_MOST_AUTHORS]:
        length += len(name)
        if length > _LONGEST:
            break
        kept.append(name)
    more = len(known) - len(kept)
    return (*kept, *((f"and {more} more",) if more else ()))


def _address(text: str) -> str:
    """Return an address of the web, or nothing for any other, which no page should link to."""
    short = _short(text)
    return short if short.lower().startswith(("https://", "http://")) else ""


def _short(text: str) -> str:
    """Return a text without control characters, cut to a length that a page can show."""
    return "".join(one if one.isprintable() else " " for one in text).strip()[:_LONGEST]

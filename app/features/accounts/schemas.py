"""Logging in over HTTP."""

from pydantic import BaseModel, ConfigDict, Field


class Credentials(BaseModel):
    """A user name and a password."""

    model_config = ConfigDict(extra="forbid")

    username: str = Field(min_length=1, max_length=80)
    password: str = Field(min_length=1, max_length=200)


class AccountView(BaseModel):
    """Who is signed in."""

    id: str
    username: str
    role: str


class SignedInView(BaseModel):
    """The answer to a login."""

    account: AccountView


class WhoView(BaseModel):
    """Who is signed in; null where nobody is, which is no error."""

    account: AccountView | None

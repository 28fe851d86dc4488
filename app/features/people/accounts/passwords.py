"""Passwords: hashed with argon2id, long rather than complicated, never the obvious.

Length and a refusal of what others know are what NIST SP 800-63B asks of passwords; it advises
against rules about digits and signs.
"""

import secrets
from functools import lru_cache

from argon2 import PasswordHasher
from argon2.exceptions import VerificationError

from app.errors import InvalidInput

MIN_LENGTH = 12
MAX_LENGTH = 200
MIN_DIFFERENT = 5
_HASHER = PasswordHasher()


def hash_password(password: str) -> str:
    """The argon2id hash with its salt and costs."""
    return _HASHER.hash(password)


def is_password(stored: str | None, password: str) -> bool:
    """Whether `password` belongs to the stored hash; takes as long where there is none."""
    try:
        _HASHER.verify(stored or _nobody(), password)
    except VerificationError:
        return False
    return stored is not None


@lru_cache(maxsize=1)
def _nobody() -> str:
    return _HASHER.hash(secrets.token_urlsafe(16))


def require_good(password: str, username: str) -> None:
    """Raise InvalidInput, without repeating the password, where it would be guessed soon."""
    problem = None
    if len(password) < MIN_LENGTH:
        problem = f"it has {len(password)} characters"
    elif len(set(password.casefold())) < MIN_DIFFERENT:
        problem = "it repeats a few characters"
    elif username.casefold() in password.casefold() and len(password) < MIN_LENGTH + len(username):
        problem = "it is mostly the user name"
    elif "reembody" in password.casefold() and len(password) < MIN_LENGTH + len("reembody"):
        problem = "it is mostly the name of this program"
    if problem:
        raise InvalidInput(
            f"this password is too easy to guess: {problem}",
            valid=f"{MIN_LENGTH} to {MAX_LENGTH} characters, such as four or five random words",
            remedy="Choose a longer one; spaces are welcome.",
        )

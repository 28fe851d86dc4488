"""The engine's own error: it knows no HTTP; the service translates it."""


class Refused(ValueError):
    """A command that cannot be done now: what, the value met, what would be valid, the way out."""

    def __init__(self, message: str, *, value: object, valid: object, remedy: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.value = value
        self.valid = valid
        self.remedy = remedy

"""What is wrong with a model's file, and where."""


class HumanoidFileError(ValueError):
    """A model's file cannot be read.

    Attributes:
        reason: what is wrong and what is valid.
        place: where in the file, such as `accessors.3`; empty where the whole file is meant.
    """

    def __init__(self, reason: str, place: str = "") -> None:
        self.reason, self.place = reason, place
        super().__init__(f"{place}: {reason}" if place else reason)

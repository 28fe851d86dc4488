"""What can be asked of a simulation that it cannot do."""


class SimulationError(ValueError):
    """The model is no avatar, a name is not in it, or a value or time cannot be."""

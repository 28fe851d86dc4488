"""How well predictions hold against walks that a model has not seen."""

"""Maps of suitability over the parameters, and how they are interpolated."""

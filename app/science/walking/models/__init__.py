"""Models of how people walk: fitting, sampling, prediction."""

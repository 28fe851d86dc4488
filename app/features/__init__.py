"""The product's features, one package each; a feature only uses the services of other features."""

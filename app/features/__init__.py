"""The product's features, one package each; a feature uses only the services of other features."""

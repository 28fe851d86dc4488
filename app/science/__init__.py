"""The science of Reembody: arrays in, frozen results out; no web, database or settings."""

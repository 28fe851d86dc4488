"""`reembody analyse`: tests of any tidy table."""

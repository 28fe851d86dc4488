"""`reembody serve` and `reembody tls`."""

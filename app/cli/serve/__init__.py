"""The commands `reembody serve` and `reembody tls`."""

"""One folder per capability. A feature may call another feature's service, nothing else of it."""

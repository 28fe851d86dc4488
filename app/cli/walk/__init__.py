"""`reembody walk`: how people walk."""

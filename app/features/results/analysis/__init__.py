"""From the record to tables, scores and figures."""

"""Tables, codebook and figures."""

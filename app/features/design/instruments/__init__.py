"""The library of instruments: every version that was ever stored, and trying one out."""

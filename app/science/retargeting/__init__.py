"""Any body's movement on any avatar."""

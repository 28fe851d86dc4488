"""What takes how much room."""

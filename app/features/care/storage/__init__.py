"""What takes how much room, and for how many more sessions there is some."""

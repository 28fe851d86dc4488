"""What operators see of sessions and what they order: views, commands, live news."""

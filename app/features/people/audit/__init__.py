"""What people of the lab did, on a chain that shows every later change."""

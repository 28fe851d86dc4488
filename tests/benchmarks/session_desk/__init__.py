"""What an operator's cockpit and a participant's tablet cost and how soon they answer."""

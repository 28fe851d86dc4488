"""Measure the cost and response times of an operator's cockpit and a participant's tablet."""

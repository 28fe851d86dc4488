"""The watch over the headset, and its alarms on the record."""

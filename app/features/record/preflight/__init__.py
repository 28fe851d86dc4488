"""What should be in order before a participant puts the headset on."""

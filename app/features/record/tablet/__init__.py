"""The participant's tablet: the screens it shows, and what it sends."""

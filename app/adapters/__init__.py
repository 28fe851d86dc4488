"""What speaks a foreign tongue: motion-capture and exchange formats, each at the edge."""

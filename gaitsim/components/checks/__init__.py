"""What a component file may say, read from its text and its declarations."""

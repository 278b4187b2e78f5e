"""Search over vectors and scores; nothing here knows what is being tuned."""

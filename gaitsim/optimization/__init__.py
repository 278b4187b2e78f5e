"""Search over vectors and scores. This package does not know what is tuned."""

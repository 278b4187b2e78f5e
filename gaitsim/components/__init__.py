"""Component files of a library: finding, loading and checking them."""

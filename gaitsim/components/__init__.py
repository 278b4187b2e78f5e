"""Component files of a library: found, loaded, and held against their kind."""

"""Finding, loading and checking component files."""

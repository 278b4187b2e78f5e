import gaitsim.compiler  # noqa: F401  MuJoCo is imported there first

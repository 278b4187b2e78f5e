"""gaitsim: neuromuscular gait models from YAML, simulated in native code."""

__version__ = "0.1.0"

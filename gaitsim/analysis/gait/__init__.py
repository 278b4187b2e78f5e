"""Figures and numbers of a walk: legs, footsteps, joints, and what people do."""

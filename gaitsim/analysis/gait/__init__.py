"""Figures and numbers of gait: legs, footsteps, joints, and comparison with people."""

"""Evaluating candidates: in this process, on all cores, or on a Dask cluster."""

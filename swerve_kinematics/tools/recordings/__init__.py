"""Drives that were recorded, in files or live: what calibration and checks start from."""

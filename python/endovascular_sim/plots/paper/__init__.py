"""Figures and tables of "A robust and real-time vascular intervention simulation based on Kirchhoff elastic rod"."""

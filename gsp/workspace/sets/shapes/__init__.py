"""Regions as shapes: outlines, surfaces, pictures, files, and the largest body inside."""

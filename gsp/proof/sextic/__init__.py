"""Proofs that |det J| of six D1 legs is nowhere above a number: polynomials over boxes of poses.

With a quaternion q of the rotation, |det J| = |P(p, q)| / Π |E_i|. P is a polynomial of degree 3 in
the position and homogeneous of degree 6 in q; E_i = (p − a_i) q + q b_i is a quaternion of length
l_i |q|. `coefficients.py` computes P exactly, `lengths.py` and `expansions.py` expand both over a
box, `excess.py` compares them, `halving.py` halves boxes, and `region.py` makes the problem of a
design. See `docs/proofs.md`.
"""

"""Proofs over boxes of poses: certificates of regularity and limits."""

from gsp.proof.certificate import Certificate, read_certificate
from gsp.proof.certify import certify
from gsp.proof.tolerances import Tolerances

__all__ = ["Certificate", "Tolerances", "certify", "read_certificate"]

"""Proofs along whole curves of poses."""

from gsp.proof.paths.certificate import PathCertificate
from gsp.proof.paths.certify import certify_path

__all__ = ["PathCertificate", "certify_path"]

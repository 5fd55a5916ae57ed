"""The independent check of certificates."""

from gsp.proof.verification.check import Verification, verify

__all__ = ["Verification", "verify"]
